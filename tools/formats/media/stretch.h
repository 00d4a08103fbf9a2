/// @file
/// Sound faster or slower at the same pitch.
///
///     TimeStretch slow(48000, 2, 0.8);          // lasts a quarter longer
///     for (...) slow.push(samples, out);
///     slow.finish(out);
///
/// Overlapping pieces of 30 ms are shifted by up to 9 ms so that their waves continue each other
/// (WSOLA: W. Verhelst, M. Roelands, ICASSP 1993). A sound is within 13 ms of its place at speeds
/// of 0.8 to 1.25, within 24 ms at half the speed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace animeme::media {

/// Stretches a stream of samples. Memory does not grow with it. Copyable.
class TimeStretch {
 public:
  /// `sample_rate` in Hz, `channels` of interleaved samples, `speed` 0.05..20: 2 is twice as fast.
  TimeStretch(int sample_rate, int channels, double speed);

  /// Takes whole frames of samples, and appends those that are known to `out`.
  void push(std::span<const float> samples, std::vector<float>& out);
  /// Appends the rest. All in all the result has as many frames as were pushed, divided by the
  /// speed and rounded.
  void finish(std::vector<float>& out);

 private:
  float sample(std::int64_t frame, std::size_t channel) const;
  void mix(std::int64_t first, std::vector<float>& out) const;
  std::int64_t best_shift(std::int64_t ideal);
  bool step(bool last, std::vector<float>& out);

  std::size_t channels_;
  double speed_;
  std::int64_t half_;    // frames of half a piece
  std::int64_t search_;  // frames by which a piece may be shifted
  std::vector<float> window_;
  std::vector<float> next_, near_;  // all channels together: what follows the piece before, and
                                    // around the ideal place
  std::vector<float> in_;           // interleaved, from frame `first_` on
  std::int64_t first_ = 0;
  std::int64_t pushed_ = 0;  // frames
  std::int64_t given_ = 0;   // frames of the result
  std::int64_t piece_ = 0;   // the next one; its middle belongs at piece_ * half_
  std::int64_t before_ = 0;  // where the one before begins in the input
};

}  // namespace animeme::media
