/// @file
/// How well a recording fits each state of each phone, frame by frame, and what it sounds like when
/// nobody says what it is. Internal. Source: tools/speech/voice/engines.md, section 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/cepstra.h"
#include "tools/speech/voice/sound_model.h"
#include "tools/speech/voice/speech_part.h"

namespace animeme::voice {

/// What is measured of a recording.
struct MeasuredSound {
  std::vector<Cepstrum> cepstra;     ///< of each frame
  std::vector<float> levels;         ///< of the same frames, dB, over 0.1 s
  std::vector<std::uint8_t> speech;  ///< SpeechPart::speech
};

/// Log likelihoods of frames of 10 ms, less those of the free path: 0 is as good as the best phone.
struct FrameScores {
  std::size_t states = 0;          ///< of the model, three a phone
  std::vector<float> values;       ///< frame by frame
  std::vector<std::uint8_t> free;  ///< the phone of the free path, index of SoundModel::phones
  std::vector<float> levels;       ///< dB above what is quiet here
  float range = 0;                 ///< dB from what is quiet here to what is loud

  /// How many.
  std::size_t frames() const { return states == 0 ? 0 : values.size() / states; }
  /// The scores of all states in one of them.
  std::span<const float> operator[](std::size_t frame) const {
    return std::span(values).subspan(frame * states, states);
  }
};

/// Measures speech; its noise is reduced, and a trace of noise is laid under digital silence.
MeasuredSound measure_sound(CepstraReader& reader, const SpeechPart& part);

/// Scores of frames `first` to `first` + `count`; what is quiet and loud is judged by their
/// surroundings. Past the end there are none.
FrameScores score_frames(const SoundModel& model, const MeasuredSound& sound, std::size_t first,
                         std::size_t count);

}  // namespace animeme::voice
