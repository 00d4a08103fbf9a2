/// @file
/// What a control can be: bounds, and controls that undo each other. A sum of smooth curves knows
/// neither; a blend shape below 0 turns a face inside out. Kept by synthesise().
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

/// Up to this the two shapes of a pair may be above 0 together: no eye sees it, and each alone is
/// guessed best that way.
inline constexpr double kSharedByShapes = 0.02;

/// What one control can be.
struct ControlLimit {
  double low = -std::numeric_limits<double>::infinity();  ///< least value, in its units
  double high = std::numeric_limits<double>::infinity();  ///< largest value, >= low
  /// Index of the control that undoes this one, -1: none. Of the two at most one is above `shared`.
  std::int32_t opposite = -1;
  double shared = 0;  ///< in its units, >= 0, the same for both: what nobody sees

  /// Nothing is limited.
  bool free() const { return *this == ControlLimit{}; }
  friend bool operator==(const ControlLimit&, const ControlLimit&) = default;
};

/// Limits that names tell: ARKit's 52 shapes, in any spelling that fap::find_arkit() knows, lie in
/// 0..1, and the two of a pair (jaw and mouth left and right, gaze up and down, in and out, blink
/// and wide, smile and frown of a side) undo each other, if both are there. All other names are
/// free. mouthClose and jawOpen are no pair: ARKit's mouthClose shuts the lips of an open jaw.
std::vector<ControlLimit> natural_limits(std::span<const std::string> names);

/// Frees the pairs of which `apart(one, other)`, indices, is false.
void untie(std::vector<ControlLimit>& limits,
           const std::function<bool(std::size_t, std::size_t)>& apart);

/// Nothing if all are free, else the limits as they are.
std::vector<ControlLimit> settled(std::vector<ControlLimit> limits);

/// A table of limits, tab separated or with commas, with a header of `control`, `low`, `high` and,
/// if wanted, `opposite` (the name of another control); empty fields limit nothing. Controls of
/// `names` that it does not name keep what `natural_limits()` says; rows about others are passed
/// over, so that one table serves many takes. Errors: syntax (header, fields, numbers; with line),
/// invalid_argument (low above high, a control that is named twice, an opposite that is the control
/// itself or has another opposite).
Result<std::vector<ControlLimit>> read_limits(std::string_view text,
                                              std::span<const std::string> names);

/// Puts every value within its limits: first what pairs have in common beyond `shared` is taken
/// from both, then values out of bounds are moved to them. `limits` has one entry a channel, or
/// none.
void apply_limits(Signal& signal, std::span<const ControlLimit> limits);

}  // namespace animeme::dam
