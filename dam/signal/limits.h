/// @file
/// Limits of controls: bounds, and controls that cancel each other. A sum of smooth curves respects
/// neither; a blend shape below 0 turns a face inside out. Enforced by synthesise().
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// Up to this value both shapes of a pair may be above 0: it is invisible, and each alone is
/// predicted best that way.
inline constexpr double kSharedByShapes = 0.02;

/// Limits of one control.
struct ControlLimit {
  double low = -std::numeric_limits<double>::infinity();  ///< least value, in its units
  double high = std::numeric_limits<double>::infinity();  ///< largest value, >= low
  /// Index of the control that cancels this one, -1: none. At most one of the two is above
  /// `shared`.
  std::int32_t opposite = -1;
  double shared = 0;  ///< invisible value, in its units, >= 0, the same for both

  /// True if nothing is limited.
  bool free() const { return *this == ControlLimit{}; }
  friend bool operator==(const ControlLimit&, const ControlLimit&) = default;
};

/// Limits implied by names: ARKit's 52 shapes, in any spelling that fap::find_arkit() knows, are in
/// 0..1, and the two of a pair (jaw and mouth left and right, gaze up and down, in and out, blink
/// and wide, smile and frown of a side) cancel each other, if both are present. All other names are
/// unlimited. mouthClose and jawOpen are not a pair: ARKit's mouthClose closes the lips of an open
/// jaw.
std::vector<ControlLimit> natural_limits(std::span<const std::string> names);

/// Releases the pairs for which `apart(one, other)`, indices, is false.
void untie(std::vector<ControlLimit>& limits,
           const std::function<bool(std::size_t, std::size_t)>& apart);

/// Empty if all are unlimited, else the limits unchanged.
std::vector<ControlLimit> settled(std::vector<ControlLimit> limits);

/// Reads a table of limits, tab separated or with commas, with a header of `control`, `low`, `high`
/// and optionally `opposite` (the name of another control); empty fields limit nothing. Controls of
/// `names` that are not in the table keep `natural_limits()`; rows about other controls are
/// ignored, so that one table can serve many takes. Errors: syntax (header, fields, numbers; with
/// line), invalid_argument (low above high, a control that is named twice, an opposite that is the
/// control itself or has another opposite).
Result<std::vector<ControlLimit>> read_limits(std::string_view text,
                                              std::span<const std::string> names);

/// Puts every value within its limits: first the common part of pairs beyond `shared` is subtracted
/// from both, then values out of bounds are clamped. `limits` has one entry per channel, or is
/// empty.
void apply_limits(Signal& signal, std::span<const ControlLimit> limits);

}  // namespace animeme::dam
