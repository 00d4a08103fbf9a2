// Triphone back-off: which corrections a phone in its context takes, and how they are faded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/model/model.h"

namespace animeme::dam {

/// Key of a curve; ordered as TriphoneParameters::curves.
struct CurveKey {
  std::int32_t phone = 0;
  CurveLevel level = CurveLevel::phone;
  std::int32_t left = 0, right = 0;

  friend auto operator<=>(const CurveKey&, const CurveKey&) = default;
};

inline CurveKey key_of(const ContextCurve& c) { return {c.phone, c.level, c.left, c.right}; }

/// The keys of all levels for a phone between `left` and `right` (Model::phones or kRestContext),
/// coarse to fine.
std::array<CurveKey, kCurveLevels> curve_keys(const Model& model, std::int32_t phone,
                                              std::int32_t left, std::int32_t right);

/// Local time of point i of a curve.
inline double curve_time(std::size_t i, std::size_t points, double reach) {
  return -reach + (1 + 2 * reach) * double(i) / double(points - 1);
}

/// Weight in the overlap-add: 1 in the middle of the phone, 0 from `reach` outside it, 1/2 where it
/// begins and ends.
double fade(double u, double reach);

}  // namespace animeme::dam
