// What the parts of a behaviour are made of: random draws, noise of a band, gestures, followers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "dam/maths/random.h"

namespace animeme::dam::behaviour {

inline constexpr double kRadians = std::numbers::pi / 180;  // of a degree

/// Seeds of parts have nothing in common, and neither have those of neighbouring seeds.
inline std::uint64_t mixed(std::uint64_t seed, std::uint64_t part) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u + part * 0xd1b54a32d192ed03u + 0x632be59bd9b4e019u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Draws from the distributions of the sources.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return random_.between(low, high); }
  bool chance(double probability) { return random_.between(0, 1) < probability; }
  std::size_t below(std::size_t count) { return random_.below(count); }
  /// Mean 0, standard deviation 1, within three of them.
  double normal() {
    const double u = std::max(random_.between(0, 1), 1e-12), v = random_.between(0, 1);
    const double n = std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    return std::clamp(n, -3.0, 3.0);
  }
  /// Log-normal by its mean and standard deviation.
  double skewed(double mean, double deviation) {
    const double ratio = deviation / mean, variance = std::log(1 + ratio * ratio);
    return mean * std::exp(std::sqrt(variance) * normal() - variance / 2);
  }
  /// Exponential with this mean, cut off at `most`.
  double exponential(double mean, double most) {
    const double u = random_.between(0, 1);
    return -mean * std::log(1 - u * (1 - std::exp(-most / mean)));
  }

 private:
  Random random_;
};

/// From 0 at x <= 0 to 1 at x >= 1, with no corner in speed nor acceleration (minimum jerk).
inline double smooth_step(double x) {
  if (x <= 0) return 0;
  return x >= 1 ? 1.0 : x * x * x * (10 + x * (6 * x - 15));
}

/// Noise below about 0.4 / step Hz with mean 0 and variance 1: a cubic B-spline of random values. A
/// function of time, so that it is the same at any frame rate.
class SlowNoise {
 public:
  SlowNoise(std::uint64_t key, double step) : key_(key), per_second_(1 / step) {}
  double at(double time) {
    const double x = time * per_second_, whole = std::floor(x), f = x - whole;
    const auto index = std::int64_t(whole);
    if (index != index_) fill(index);
    const double g = 1 - f;
    const double w0 = g * g * g, w3 = f * f * f;
    const double w1 = 4 - 6 * f * f + 3 * w3, w2 = 4 - 6 * g * g + 3 * w0;
    return kScale * (w0 * knots_[0] + w1 * knots_[1] + w2 * knots_[2] + w3 * knots_[3]);
  }

 private:
  // 1 / 6 of the spline; the squares of its weights add up to 0.479 in the mean over time.
  static constexpr double kScale = 1 / (6 * 0.692);
  void fill(std::int64_t index) {
    for (std::size_t i = 0; i < knots_.size(); ++i) {
      Random random(mixed(key_, std::uint64_t(index) + i));
      knots_[i] = random.between(-std::numbers::sqrt3, std::numbers::sqrt3);
    }
    index_ = index;
  }
  std::uint64_t key_;
  double per_second_;
  std::int64_t index_ = INT64_MIN;
  std::array<double, 4> knots_ = {};
};

/// Noise about a frequency, variance 1.
class BandNoise {
 public:
  BandNoise(std::uint64_t key, double hertz, double step)
      : in_phase_(mixed(key, 1), step),
        quadrature_(mixed(key, 2), step),
        angular_(2 * std::numbers::pi * hertz) {}
  double at(double time) {
    return in_phase_.at(time) * std::cos(angular_ * time) +
           quadrature_.at(time) * std::sin(angular_ * time);
  }

 private:
  SlowNoise in_phase_, quadrature_;
  double angular_;
};

/// Follows a target that may change at any moment, without a jump in speed (critically damped).
struct Follower {
  double value = 0, speed = 0;

  double follow(double target, double seconds, double time_constant) {
    const double away = value - target, c = speed + away / time_constant;
    const double decay = std::exp(-seconds / time_constant);
    value = target + (away + c * seconds) * decay;
    speed = (speed - c * seconds / time_constant) * decay;
    return value;
  }
};

/// Something that is raised, held and let go: from `onset` to `apex`, held until `release`, gone at
/// `end`.
template <std::size_t kChannels>
struct Gesture {
  double onset = 0, apex = 0, release = 0, end = 0;
  std::array<double, kChannels> amount = {};
  bool ending = false;  ///< belongs to the end of a phrase

  double share(double time) const {
    return smooth_step((time - onset) / (apex - onset)) *
           smooth_step((end - time) / (end - release));
  }
};

/// Gestures to come and those that are shown.
template <std::size_t kChannels>
class Gestures {
 public:
  using One = Gesture<kChannels>;

  void add(const One& gesture) {
    const auto later = [](const One& a, const One& b) { return a.onset < b.onset; };
    list_.insert(
        std::upper_bound(list_.begin() + std::ptrdiff_t(begun_), list_.end(), gesture, later),
        gesture);
  }
  /// Drops gestures that begin at `time` or later and for which `drop` holds.
  template <class Drop>
  void drop_from(double time, const Drop& drop) {
    const auto from = list_.begin() + std::ptrdiff_t(begun_);
    list_.erase(
        std::remove_if(from, list_.end(), [&](const One& g) { return g.onset >= time && drop(g); }),
        list_.end());
  }
  /// The sum at a time; times do not decrease.
  std::array<double, kChannels> at(double time) {
    while (begun_ < list_.size() && list_[begun_].onset <= time) shown_.push_back(list_[begun_++]);
    std::erase_if(shown_, [&](const One& g) { return g.end <= time; });
    if (begun_ > kForget) {
      list_.erase(list_.begin(), list_.begin() + std::ptrdiff_t(begun_));
      begun_ = 0;
    }
    std::array<double, kChannels> sum = {};
    for (const One& g : shown_) {
      const double share = g.share(time);
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += share * g.amount[c];
    }
    return sum;
  }

 private:
  static constexpr std::size_t kForget = 256;
  std::vector<One> list_, shown_;
  std::size_t begun_ = 0;  // in list_: those before it were moved to shown_
};

}  // namespace animeme::dam::behaviour
