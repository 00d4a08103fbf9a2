/// @file
/// Lips that round: what a speaker who rounds little, or a camera from the front, leaves out.
///
/// The corners of the built-in model's speaker come 3.5 % of the mouth's width nearer to each other
/// in UW than in IY, each, and his lips' way forward was not measured (one camera). On a head that
/// is nobody's O, U and W are then flat slits. So speaking adds a gesture of its own: corners
/// inwards and lips forward, for as long as a rounded sound lasts and a little before and after.
/// It is not learned but a rule, off in training and evaluation. With it UW is 0.81 as wide as IY
/// (0.90 as learned; `test_dam --gtest_filter='Rounding.Uw*'`). What it costs against the recorded
/// speaker, who does not do so: dam/measured.md, "Rules on top".
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// How far lips go at full rounding, in FAP units; between rest and the poses of visemes
/// (fap/expand.h: 175 and 440), which are drawn to be told apart, not to be spoken.
struct RoundingOptions {
  double corners = 45;        ///< FAP 6, 7 inwards, each
  double outer_corners = 36;  ///< FAP 53, 54 inwards, each
  double forward = 220;       ///< FAP 16, 17
  double before = 0.12;       ///< seconds in which the lips begin to round ...
  double after = 0.09;        ///< ... and in which they let go
};

/// How round the lips want to be, 0..1, at a time in seconds. Vowels and W, Y, SH and the like have
/// a wish (dam/script/features.h: rounding, less for open vowels; IY and its kind want none), F and
/// V want none, other consonants leave it to their neighbours; where wishes overlap it is their
/// mean.
class LipRounding {
 public:
  /// Of all phones of a script.
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

/// Adds `amount` (1: as the options say) of that gesture to the channels of a signal that are FAP
/// 6, 7, 16, 17, 53 and 54, scaled by `shown(seconds)`, 0..1. Returns the number of channels; 0:
/// a signal without them.
std::size_t add_rounding(const LipRounding& rounding, double amount,
                         const std::function<double(double)>& shown, Signal& signal,
                         const RoundingOptions& options = {});

}  // namespace animeme::dam
