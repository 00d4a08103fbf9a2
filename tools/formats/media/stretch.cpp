#include "tools/formats/media/stretch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace animeme::media {
namespace {

constexpr double kHalfPiece = 0.015;  // seconds
constexpr double kSearch = 0.009;     // seconds
constexpr std::int64_t kCoarse = 4;   // frames between those that the first search compares

}  // namespace

TimeStretch::TimeStretch(int sample_rate, int channels, double speed)
    : channels_(std::size_t(std::max(channels, 1))),
      speed_(speed),
      half_(std::max<std::int64_t>(8, std::llround(kHalfPiece * sample_rate))),
      search_(std::llround(kSearch * sample_rate)) {
  // Rises over the first half of a piece and falls over the second: two neighbours add up to 1.
  for (std::int64_t i = 0; i < half_; ++i) {
    const double phase = std::numbers::pi * (double(i) + 0.5) / double(half_);
    window_.push_back(float(0.5 - 0.5 * std::cos(phase)));
  }
}

// Silence before the beginning and behind the end.
float TimeStretch::sample(std::int64_t frame, std::size_t channel) const {
  const std::int64_t at = frame - first_;
  if (at < 0 || frame >= pushed_) return 0;
  return in_[std::size_t(at) * channels_ + channel];
}

// As many frames as `out` has, the channels added up.
void TimeStretch::mix(std::int64_t first, std::vector<float>& out) const {
  for (std::size_t i = 0; i < out.size(); ++i) {
    float sum = 0;
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      sum += sample(first + std::int64_t(i), channel);
    }
    out[i] = sum;
  }
}

// From its ideal place: where a piece continues the one before best.
std::int64_t TimeStretch::best_shift(std::int64_t ideal) {
  next_.resize(std::size_t(2 * half_));
  near_.resize(std::size_t(2 * half_ + 2 * search_));
  mix(before_ + half_, next_);
  mix(ideal - search_, near_);
  const auto likeness = [&](std::int64_t shift, std::int64_t stride) {
    const float* next = next_.data();
    const float* here = near_.data() + search_ + shift;
    float product = 0, energy = 1e-9f;
    for (std::int64_t i = 0; i < 2 * half_; i += stride) {
      product += next[i] * here[i];
      energy += here[i] * here[i];
    }
    return product / std::sqrt(energy);
  };
  // Of equal ones, as in silence, the one in the middle.
  std::int64_t best = 0;
  float most = likeness(0, kCoarse) + 1e-6f;
  for (std::int64_t shift = -search_; shift <= search_; shift += kCoarse) {
    const float found = likeness(shift, kCoarse);
    if (found > most) {
      most = found;
      best = shift;
    }
  }
  const std::int64_t around = best;
  most = likeness(best, 1) + 1e-6f;
  for (std::int64_t shift = around - kCoarse + 1; shift < around + kCoarse; ++shift) {
    if (std::abs(shift) > search_) continue;
    const float found = likeness(shift, 1);
    if (found > most) {
      most = found;
      best = shift;
    }
  }
  return best;
}

// The next piece, if what it needs is there.
bool TimeStretch::step(bool last, std::vector<float>& out) {
  const std::int64_t ideal = std::llround(double(piece_ * half_) * speed_) - half_;
  const std::int64_t need = std::max(ideal + search_, before_ + half_) + 2 * half_;
  if (!last && need > pushed_) return false;
  const std::int64_t begin = piece_ == 0 ? ideal : ideal + best_shift(ideal);
  if (piece_ > 0) {
    std::int64_t count = half_;
    if (last) {
      const std::int64_t all = std::llround(double(pushed_) / speed_);
      count = std::min(count, all - given_);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      const float rise = window_[std::size_t(i)];
      for (std::size_t channel = 0; channel < channels_; ++channel) {
        out.push_back(rise * sample(begin + i, channel) +
                      (1 - rise) * sample(before_ + half_ + i, channel));
      }
    }
    given_ += std::max<std::int64_t>(count, 0);
  }
  before_ = begin;
  ++piece_;
  // Nothing before these is read again.
  const std::int64_t following = std::llround(double(piece_ * half_) * speed_) - half_ - search_;
  const std::int64_t keep = std::clamp(std::min(before_ + half_, following), first_, pushed_);
  if (keep - first_ > 8 * half_) {
    in_.erase(in_.begin(), in_.begin() + std::ptrdiff_t(std::size_t(keep - first_) * channels_));
    first_ = keep;
  }
  return true;
}

void TimeStretch::push(std::span<const float> samples, std::vector<float>& out) {
  in_.insert(in_.end(), samples.begin(), samples.end());
  pushed_ += std::int64_t(samples.size() / channels_);
  while (step(false, out)) {
  }
}

void TimeStretch::finish(std::vector<float>& out) {
  const std::int64_t all = std::llround(double(pushed_) / speed_);
  while (given_ < all) step(true, out);
}

}  // namespace animeme::media
