/// @file
/// Pitch and level of a voice, for heads and brows that follow it (dam/behaviour).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/behaviour/prosody.h"
#include "tools/formats/media/pcm.h"

namespace animeme::voice {

/// Fundamental frequency (60 to 400 Hz) and level of a sound, every 10 ms from its beginning; the
/// values lie in the middle of 30 ms.
///
/// By the normalised cross-correlation of the sound, low-passed to 2 kHz, as RAPT does it (Talkin
/// 1995), with a preference for the pitch of the frame before, and a median over 50 ms. A frame
/// without a voice, or more than 40 dB below the loudest one, has no pitch. About 1 ms a second of
/// sound. A sound that is empty, or below 4000 Hz, gives empty lists.
dam::Prosody measure_prosody(const media::Pcm& sound);

/// The same of a sound that comes in pieces; it keeps 4000 values a second.
class ProsodyMeter {
 public:
  explicit ProsodyMeter(int sample_rate);     ///< in Hz
  void push(std::span<const float> samples);  ///< the next ones
  dam::Prosody finish();                      ///< once, at the end

 private:
  // A moving average over the last samples.
  struct Average {
    std::vector<float> last;
    std::size_t at = 0;
    double sum = 0;
    float next(float sample);
  };
  int sample_rate_;
  std::size_t ratio_;          // of the rates
  std::size_t lead_;           // values before the first sample
  std::uint64_t samples_ = 0;  // so far
  Average first_, second_;
  std::vector<float> thin_;
};

}  // namespace animeme::voice
