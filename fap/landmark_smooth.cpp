// Removes jitter of trackers: Gaussian smoothing over time.
#include <cmath>

#include "fap/detail/landmark_values.h"

namespace animeme::fap::internal {
namespace {

constexpr double kReach = 4;  // standard deviations: beyond it the bell is below 0.04 %

}  // namespace

std::vector<ValueFrame> smoothed(const std::vector<ValueFrame>& frames, const Rate& rate,
                                 double width) {
  if (!(width > 0)) return frames;
  std::vector<ValueFrame> out = frames;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto apart = [&](std::size_t j) {
      return rate.seconds(double(frames[j].number - frames[i].number));
    };
    while (apart(begin) < -kReach * width) ++begin;
    std::array<double, kFapCount + 1> sum{};
    std::array<double, kFapCount + 1> total{};
    for (std::size_t j = begin; j < frames.size() && apart(j) <= kReach * width; ++j) {
      const double weight = std::exp(-0.5 * std::pow(apart(j) / width, 2));
      for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
        if (!frames[j].mask[fap]) continue;
        sum[fap] += weight * frames[j].value[fap];
        total[fap] += weight;
      }
    }
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frames[i].mask[fap]) out[i].value[fap] = sum[fap] / total[fap];
    }
  }
  return out;
}

}  // namespace animeme::fap::internal
