/// @file
/// The random numbers of the case generator: a defined sequence, the same on every machine (the
/// distributions of the C++ library are not).
#pragma once

#include <cstdint>

namespace animeme::conformance {

/// splitmix64: any seed is good, and neighbouring seeds give unrelated sequences.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}  ///< starts the sequence

  /// The next 64 bits.
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  /// low..high, both included.
  int range(int low, int high) {
    return low + int(next() % (std::uint64_t(std::int64_t(high) - low) + 1));
  }
  bool chance(int percent) { return range(1, 100) <= percent; }  ///< true in so many of 100 cases

 private:
  std::uint64_t state_;
};

}  // namespace animeme::conformance
