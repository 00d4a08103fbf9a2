// Makes frames, clips and texts for the tests of fap.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>

#include "fap/frame.h"

namespace animeme::fap::made {

inline Frame make_frame(std::int64_t number,
                        std::initializer_list<std::pair<int, std::int32_t>> values) {
  Frame frame;
  frame.number = number;
  for (const auto& [fap, value] : values) frame.set(fap, value);
  return frame;
}

/// "0 0 1 0 ...": 68 flags without a newline.
inline std::string mask_line(std::initializer_list<int> faps) {
  std::string line;
  for (int fap = 1; fap <= kFapCount; ++fap) {
    bool set = false;
    for (const int f : faps) set = set || f == fap;
    line += fap == 1 ? "" : " ";
    line += set ? "1" : "0";
  }
  return line;
}

/// Deterministic on every machine, which the distributions of <random> are not.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  /// low..high, both included.
  std::int64_t in(std::int64_t low, std::int64_t high) {
    const std::uint64_t span = std::uint64_t(high - low) + 1;
    const std::uint64_t raw = (std::uint64_t(engine_()) << 32) | engine_();
    return low + std::int64_t(raw % span);
  }
  bool chance(int percent) { return in(0, 99) < percent; }

 private:
  std::mt19937 engine_;
};

/// A valid clip with any masks, gaps and values, FAP 1 and 2 included. Numbers start at 0.
inline Sequence random_sequence(Random& random, int frames) {
  static constexpr Rate rates[] = {{25, 1}, {25, 2}, {30000, 1001}, {401, 16},
                                   {1, 3},  {12, 1}, {12500, 1001}, {4294967295u, 4294967291u}};
  Sequence clip{rates[random.in(0, 7)], {}, "random"};
  std::int64_t number = 0;
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.number = number;
    const int density = int(random.in(0, 100));
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (!random.chance(density)) continue;
      frame.set(fap, std::int32_t(random.chance(5) ? random.in(INT32_MIN, INT32_MAX)
                                                   : random.in(-2000, 2000)));
    }
    const auto pick = [&](std::int64_t highest) { return std::int32_t(random.in(0, highest)); };
    if (random.chance(density)) {
      frame.mask.set(1);
      frame.viseme = {pick(14), pick(14), pick(63), random.chance(50)};
    }
    if (random.chance(density)) {
      frame.mask.set(2);
      frame.expression = {pick(6),  pick(63),          pick(6),
                          pick(63), random.chance(50), random.chance(50)};
    }
    clip.frames.push_back(frame);
    number += random.chance(20) ? random.in(1, 1000) : 1;
  }
  return clip;
}

}  // namespace animeme::fap::made
