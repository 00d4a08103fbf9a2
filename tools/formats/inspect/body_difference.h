/// @file
/// Differences of two body animations for each BAP, like fap/compare.h for faces.
#pragma once

#include <array>
#include <cstdint>

#include "codec/text/bap_text.h"

namespace animeme::inspect {

/// Differences of one BAP over the frames in which both have it.
struct BapDifference {
  std::int64_t frames = 0;     ///< in both
  std::int64_t differing = 0;  ///< of these, with different values
  std::int64_t only_a = 0;     ///< common frames in which only a has the BAP
  std::int64_t only_b = 0;     ///< the same for b
  double squares = 0;          ///< sum of the squares of a - b
  std::int64_t max = 0;        ///< largest absolute difference, BAP units
  std::int64_t max_frame = 0;  ///< number of the first frame with this difference

  double rms() const;  ///< root mean square, BAP units
};

/// Two body clips, frames matched by number.
struct BodyDifference {
  std::int64_t frames_a = 0;           ///< of a
  std::int64_t frames_b = 0;           ///< of b
  std::int64_t frames_both = 0;        ///< numbers in both
  bool same_rate = true;               ///< frames a second are equal
  std::int64_t mask_differences = 0;   ///< sum of only_a and only_b
  std::int64_t value_differences = 0;  ///< sum of differing
  double rms_steps = 0;                ///< over all values, in quantiser steps
  double max_steps = 0;                ///< largest, in quantiser steps
  std::int64_t first_difference = -1;  ///< number of the first different frame, -1: none
  std::array<BapDifference, fba::kBapCount + 1> bap{};  ///< by BAP number

  /// Whether rate, masks, values and frame numbers are equal.
  bool equal() const { return same_rate && first_difference < 0; }
};

/// Quantiser step of BAP `number` (1..296) at bap_quant 1.
int bap_step(int number);

/// Compares frame by frame, without whole clips in memory.
class BodyComparer {
 public:
  /// The next frame, which only one or both have under one number; numbers ascend.
  void only_a(const fba::BodyFrame& frame);
  void only_b(const fba::BodyFrame& frame);                           ///< a frame of b
  void both(const fba::BodyFrame& a, const fba::BodyFrame& b);        ///< the next common frame
  BodyDifference compared(fap::Rate rate_a, fap::Rate rate_b) const;  ///< so far

 private:
  BodyDifference difference_;
};

}  // namespace animeme::inspect
