/// @file
/// The difference of two clips, FAP by FAP.
#pragma once

#include <array>
#include <cstdint>

#include "fap/frame.h"

namespace animeme::fap {

/// Differences of one FAP over the frames in which both clips have it.
struct FapDifference {
  std::int64_t frames = 0;     ///< frames in which both clips have the FAP
  std::int64_t differing = 0;  ///< of these, how many have different values
  std::int64_t only_a = 0;     ///< frames of both clips in which only a has the FAP
  std::int64_t only_b = 0;     ///< ... only b
  // The rest is 0 for FAP 1 and 2, whose values are indices and not amounts.
  double rms = 0;              ///< root of the mean square of a - b, FAP units
  std::int64_t max = 0;        ///< largest |a - b|, FAP units
  std::int64_t max_frame = 0;  ///< number of the first frame with it
  double rms_steps = 0;        ///< rms in quantiser steps (FapInfo::quant_step)
  double max_steps = 0;        ///< largest, in quantiser steps

  friend bool operator==(const FapDifference&, const FapDifference&) = default;
};

/// Comparison of clip a with clip b. Frames are matched by their numbers.
struct Difference {
  std::int64_t frames_a = 0;           ///< frames of a
  std::int64_t frames_b = 0;           ///< frames of b
  std::int64_t frames_both = 0;        ///< numbers that both clips have
  bool same_rate = true;               ///< frames per second are equal
  std::int64_t mask_differences = 0;   ///< sum of only_a and only_b over all FAPs
  std::int64_t value_differences = 0;  ///< sum of differing over all FAPs
  double rms_steps =
      0;  ///< over all low-level values in quantiser steps, so that FAPs can be added
  double max_steps = 0;                ///< largest of all FAPs
  int max_fap = 0;                     ///< FAP with max_steps, 0: no difference
  std::int64_t first_difference = -1;  ///< number of the first frame that differs or that only one
                                       ///< clip has; -1: none
  std::array<FapDifference, kFapCount + 1> fap{};  ///< index = FAP number, 0 unused

  /// Same rate, same frames, same masks, same values. Names do not matter.
  bool equal() const { return same_rate && first_difference < 0; }

  friend bool operator==(const Difference&, const Difference&) = default;
};

/// Compares frame by frame, for clips that do not fit into memory.
class Comparer {
 public:
  /// The next frame, of one clip only or of both under one number; numbers ascend.
  void only_a(const Frame& frame);
  void only_b(const Frame& frame);                      ///< likewise
  void both(const Frame& a, const Frame& b);            ///< likewise
  Difference compared(Rate rate_a, Rate rate_b) const;  ///< result so far

 private:
  void note_difference(std::int64_t number);
  void compare_values(std::size_t fap, const Frame& a, const Frame& b);

  Difference difference_;
  std::array<double, kFapCount + 1> squares_{};
};

/// Compares coded content: an absent FAP is not the same as a FAP of value 0. To compare what a
/// player shows, fill() both clips first. Frame numbers must ascend in both. Linear in the number
/// of frames, never fails.
Difference compare(const Sequence& a, const Sequence& b);

}  // namespace animeme::fap
