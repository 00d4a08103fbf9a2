// Two channels to one.
#pragma once

#include <span>
#include <vector>

namespace animeme::media {

/// The mean of both channels; the left one alone where the right one is its opposite, as a wrongly
/// soldered cable or a "wide" effect makes it: their mean would be silence. Does not depend on the
/// pieces that the sound comes in.
class StereoMix {
 public:
  explicit StereoMix(int sample_rate);
  /// Appends a sample for each pair (left, right).
  void mix(std::span<const float> pairs, std::vector<float>& out);

 private:
  double forget_, step_;       // a sample
  double both_ = 0, sum_ = 0;  // powers: of the channels, of their sum
  double left_ = 0;            // 0: the mean, 1: the left channel
  bool opposite_ = false;
};

}  // namespace animeme::media
