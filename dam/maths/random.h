// Random numbers that are the same on every machine and with every standard library: SplitMix64
// (Steele, Lea and Flood).
#pragma once

#include <cstddef>
#include <cstdint>

namespace animeme::dam {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// 0 .. count - 1. `count` is far below 2^32, so the bias of the product is nothing.
  std::size_t below(std::size_t count) {
    return std::size_t(((next() >> 32) * std::uint64_t(count)) >> 32);
  }
  /// low .. high.
  double between(double low, double high) {
    return low + (high - low) * double(next() >> 11) / 9007199254740992.0;
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace animeme::dam
