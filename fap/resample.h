/// @file
/// Clips at another frame rate, by interpolation.
#pragma once

#include <cstdint>
#include <functional>

#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::fap {

/// Converts complete frames (fap/fill.h) from one rate to another, one by one.
///
///     Resampler resampler({30000, 1001}, {25, 1});
///     for (const Frame& frame : filled.frames) resampler.push(frame, emit);
///     resampler.finish(emit);
///
/// Low-level FAPs are interpolated linearly and rounded; FAP 1 and 2 are those of the nearer frame.
/// The duration is kept: see frames().
class Resampler {
 public:
  using Emit = std::function<void(const Frame&)>;  ///< gets each frame, numbered from 0

  Resampler(Rate from, Rate to);  ///< both rates valid

  /// The next frame, whatever its number.
  void push(const Frame& frame, const Emit& emit);
  /// No more frames follow: emits the rest of the last frame's duration.
  void finish(const Emit& emit);

  /// Number of output frames for `frames` input frames: the nearest to the same duration, at least
  /// 1 (0 for 0).
  std::int64_t frames(std::int64_t frames) const;

 private:
  double step_;  // frames in, per frame out
  Frame last_;
  std::int64_t in_ = 0, out_ = 0;
};

inline constexpr std::int64_t kMostResampled = 20'000'000;  ///< frames: 5 hours at 1000 a second
inline constexpr std::int64_t kMostOfOne = 100'000;         ///< frames that one frame becomes

/// Whether so many frames may be converted. Errors: invalid_argument (a rate that is not valid),
/// out_of_range (more than kMostResampled frames, or kMostOfOne of a single one).
Result<void> check_resampling(Rate from, Rate to, std::int64_t frames);

/// A whole clip of complete frames; check_resampling() says whether that is sensible. Its name is
/// kept.
Sequence resample(const Sequence& filled, Rate to);

}  // namespace animeme::fap
