// Random legal clips for property tests, the same for the same seed on every machine.
#pragma once

#include <cstdint>

#include "fap/frame.h"

namespace animeme::test {

/// A small generator with a defined sequence (std distributions differ between libraries).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2862933555777941757ULL + 3037000493ULL) {}

  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return std::uint32_t(state_ >> 32);
  }
  /// low..high, both included.
  int range(int low, int high) { return low + int(next() % std::uint32_t(high - low + 1)); }
  bool chance(int percent) { return range(1, 100) <= percent; }

 private:
  std::uint64_t state_;
};

/// A clip of `frames` frames: a random set of FAPs that walk at random, FAP 1 and 2 now and then,
/// frames that leave FAPs out, and gaps in the numbers if `gaps`.
inline fap::Sequence random_clip(std::uint64_t seed, int frames, bool gaps = false) {
  Random random(seed);
  fap::Sequence clip;
  clip.rate = random.chance(50) ? fap::Rate{25, 1} : fap::Rate{30000, 1001};
  clip.name = "random";
  fap::Mask used;
  for (std::size_t fap = 1; fap <= fap::kFapCount; ++fap) used[fap] = random.chance(40);
  fap::Frame frame;
  std::int64_t number = 0;
  for (int i = 0; i < frames; ++i) {
    frame.number = number;
    frame.mask.reset();
    number += gaps && random.chance(20) ? random.range(1, 40) : 1;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!used[fap] || random.chance(10)) {
        frame.value[fap] = 0;
        continue;
      }
      frame.mask.set(fap);
      frame.value[fap] = random.range(-1000, 1000);
    }
    frame.viseme = {};
    frame.expression = {};
    if (used[1]) {
      frame.mask.set(1);
      frame.viseme = {random.range(0, 14), random.range(0, 14), random.range(0, 63),
                      random.chance(50)};
    }
    if (used[2]) {
      frame.mask.set(2);
      frame.expression = {random.range(0, 6),  random.range(0, 63), random.range(0, 6),
                          random.range(0, 63), random.chance(50),   random.chance(50)};
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

}  // namespace animeme::test
