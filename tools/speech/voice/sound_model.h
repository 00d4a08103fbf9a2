/// @file
/// The acoustic model of pocketsphinx, read by ourselves: how well a frame of sound fits each state
/// of each phone. The library gives paths only, and a face needs to know what else it may have
/// been. Internal. Source: tools/speech/voice/engines.md, section 3.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::voice {

inline constexpr std::size_t kCepstra = 13;        ///< numbers of a frame of sound
inline constexpr std::size_t kStreams = 3;         ///< them, their slope, the slope of that
inline constexpr std::size_t kStatesPerPhone = 3;  ///< beginning, middle, end
using Cepstrum = std::array<float, kCepstra>;      ///< of 10 ms
using Features = std::array<Cepstrum, kStreams>;   ///< what a state is compared with

/// Phones without context, three states each.
struct SoundModel {
  std::vector<std::string> phones;  ///< "AA" ... "SIL", and noises as "+NSN+"
  std::size_t densities = 0;        ///< Gaussians of a phone and stream
  std::vector<float> means;         ///< phone, stream, dimension, density
  std::vector<float> precisions;    ///< the same: half of one through the variance
  std::vector<float> constants;     ///< phone, stream, density: log of the factor
  std::vector<float> weights;       ///< phone, stream, state, density
  std::vector<float> stay;          ///< phone, state: probability to stay for a frame

  std::size_t states() const { return phones.size() * kStatesPerPhone; }  ///< of all phones
};

/// Reads mdef, means, variances, sendump and transition_matrices of a folder. Errors: not_found (a
/// file is not there), syntax (it is damaged), unsupported (a model of another kind).
Result<SoundModel> read_sound_model(const std::string& folder);

/// The log likelihood of every state, phone by phone. `scores` has states() of them.
void score_states(const SoundModel& model, const Features& frame, std::span<float> scores);

}  // namespace animeme::voice
