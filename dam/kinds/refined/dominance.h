// The dominance of the refined model: how much a phone has to say at a moment, in seconds from it.
// Source: dam/lipsync.md, section 2.
#pragma once

#include <algorithm>
#include <cmath>

#include "dam/model/model.h"

namespace animeme::dam {

/// Widths beyond which dominance counts as 0: sqrt(-ln 1e-5), where 1e-5 of the strength is left.
inline constexpr double kRefinedReach = 3.3930;
/// A phone's strength grows with its duration by at most these factors of the usual one.
inline constexpr double kShortestShare = 0.3, kLongestShare = 3;

/// Factor of the strength of a phone that lasts `duration` where `usual` is the mean.
inline double duration_strength(double duration, double usual, double exponent) {
  if (exponent == 0) return 1;
  return std::pow(std::clamp(duration / usual, kShortestShare, kLongestShare), exponent);
}

/// D without its strength, for distances before and after the phone (seconds, >= 0, one is 0).
inline double fall_off(const PhoneDominance& d, double before, double after) {
  const double b = before / d.left, a = after / d.right;
  return before == 0 && after == 0 ? 1.0 : std::exp(-b * b - a * a);
}

inline double reach_before(const PhoneDominance& d) { return kRefinedReach * d.left; }
inline double reach_after(const PhoneDominance& d) { return kRefinedReach * d.right; }

/// Legendre polynomials 0..4 of 2u - 1, u clamped to [-margin, 1 + margin].
inline void refined_basis(double u, double margin, double* out) {
  const double v = 2 * std::clamp(u, -margin, 1 + margin) - 1, v2 = v * v;
  out[0] = 1;
  out[1] = v;
  out[2] = 0.5 * (3 * v2 - 1);
  out[3] = 0.5 * v * (5 * v2 - 3);
  out[4] = 0.125 * ((35 * v2 - 30) * v2 + 3);
}

}  // namespace animeme::dam
