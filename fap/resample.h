/// @file
/// Clips at another rate: frames between frames.
#pragma once

#include <cstdint>
#include <functional>

#include "fap/frame.h"
#include "fap/rate.h"

namespace animeme::fap {

/// From complete frames at one rate (fap/fill.h) to frames at another, one by one.
///
///     Resampler resampler({30000, 1001}, {25, 1});
///     for (const Frame& frame : filled.frames) resampler.push(frame, emit);
///     resampler.finish(emit);
///
/// Low-level FAPs are the straight line between two frames, rounded; FAP 1 and 2 those of the
/// nearer one. Duration is kept: frames() of them come out for so many that went in.
class Resampler {
 public:
  using Emit = std::function<void(const Frame&)>;  ///< gets each frame, numbered from 0

  Resampler(Rate from, Rate to);  ///< both rates valid

  /// The next frame, whatever its number.
  void push(const Frame& frame, const Emit& emit);
  /// No more will come: what the last frame lasts.
  void finish(const Emit& emit);

  /// How many come out in all for `frames` in all: the nearest to the same duration, 1 at least
  /// (0 for 0).
  std::int64_t frames(std::int64_t frames) const;

 private:
  double step_;  // frames in, per frame out
  Frame last_;
  std::int64_t in_ = 0, out_ = 0;
};

/// A whole clip of complete frames. Its name is kept.
Sequence resample(const Sequence& filled, Rate to);

}  // namespace animeme::fap
