/// @file
/// The part of a recording that has speech, at the level that the model was made for. Measures are
/// taken there, so that silence and noise before and behind the speech, however long, change
/// nothing. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace animeme::voice {

/// Samples in a block of 10 ms at 16 kHz.
inline constexpr std::size_t kSpeechBlock = 160;

/// What find_speech() finds.
struct SpeechPart {
  /// 16 kHz, without rumble, between -1 and 1, from half a second before the first speech to half a
  /// second behind the last, as far as the recording goes. The whole recording, without zeros at
  /// its ends, where nothing stands out.
  std::vector<float> samples;
  std::size_t first = 0;  ///< the sample of the recording that is samples[0]
  /// Of each block of `samples`: 1 if it is speech by its level, compared with 15 s to either side.
  std::vector<std::uint8_t> speech;
  float loud = 0;  ///< the peak that a tenth of the blocks with speech exceeds
  double snr = 0;  ///< speech above the noise in its pauses, dB, 0 to 100
};

/// Finds the speech by levels. Samples that are no numbers count as 0. A recording of any length;
/// an empty one has an empty part. A recording that is moved here is not copied.
SpeechPart find_speech(std::vector<float> recording);

}  // namespace animeme::voice
