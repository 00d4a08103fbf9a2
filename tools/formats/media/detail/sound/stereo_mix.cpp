#include "tools/formats/media/detail/sound/stereo_mix.h"

#include <algorithm>

namespace animeme::media {

namespace {

constexpr double kMemory = 0.3;  // seconds that powers are averaged over
constexpr double kFade = 0.02;   // seconds from one mix to the other
// The power of the sum to that of both: 1 of equal channels, 0.5 of independent ones.
constexpr double kOpposite = 0.02, kNoLonger = 0.1;

}  // namespace

StereoMix::StereoMix(int sample_rate)
    : forget_(1 / (kMemory * sample_rate)), step_(1 / (kFade * sample_rate)) {}

void StereoMix::mix(std::span<const float> pairs, std::vector<float>& out) {
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    const double left = double(pairs[i]), right = double(pairs[i + 1]);
    both_ += forget_ * (left * left + right * right - both_);
    sum_ += forget_ * (0.5 * (left + right) * (left + right) - sum_);
    opposite_ = sum_ < (opposite_ ? kNoLonger : kOpposite) * both_;
    left_ = std::clamp(left_ + (opposite_ ? step_ : -step_), 0.0, 1.0);
    out.push_back(float(0.5 * ((1 + left_) * left + (1 - left_) * right)));
  }
}

}  // namespace animeme::media
