/// @file
/// A rule for lip rounding: lips forward, which a frontal camera does not show.
///
/// The forward motion of the built-in model's speaker was not measured (one camera). So synthesis
/// adds it for as long as a rounded sound lasts and a little before and after. The corners are left
/// as learned: they are each 3.5 % of the mouth's width closer to each other in UW than in IY, as
/// he has them. This is a rule, not learned, and off in training and evaluation.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// Motion of the lips at full rounding, in FAP units; half of the poses of visemes
/// (fap/expand.h: 440), which are drawn to be distinguished, not to be spoken.
struct RoundingOptions {
  double forward = 220;  ///< FAP 16, 17
  double before = 0.12;  ///< seconds in which the lips round ...
  double after = 0.09;   ///< ... and release
};

/// Target rounding of the lips, 0..1, over time in seconds. Vowels and W, Y, SH and the like have a
/// target (dam/script/features.h: rounding, less for open vowels; 0 for IY and similar vowels), F
/// and V have 0, other consonants take those of their neighbours; overlapping targets are averaged.
class LipRounding {
 public:
  /// Considers all phones of a script.
  explicit LipRounding(const Script& script, const RoundingOptions& options = {});
  /// Times may come in any order; cheap if they ascend.
  double operator()(double time) const;

 private:
  struct Wish {
    double start, end;  // seconds
    double round;       // 0..1
    double weight;
  };
  std::vector<Wish> wishes_;  // by start
  RoundingOptions options_;
  double longest_ = 0;
};

/// Adds `amount` (1: as in the options) of that gesture to the channels of a signal that are FAP 16
/// and 17, scaled by `shown(seconds)`, 0..1. Returns the number of channels; 0: a
/// signal without them.
std::size_t add_rounding(const LipRounding& rounding, double amount,
                         const std::function<double(double)>& shown, Signal& signal,
                         const RoundingOptions& options = {});

}  // namespace animeme::dam
