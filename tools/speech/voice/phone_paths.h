/// @file
/// What may have been said: all paths through the phones at once, forwards, and some of them drawn
/// by their probability, backwards. Internal. Source: tools/speech/voice/engines.md, section 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "tools/speech/voice/sound_model.h"

namespace animeme::voice {

/// How much the sound and the language are believed.
struct PathOptions {
  double sound = 0.3;    ///< exponent of likelihoods: frames that follow each other tell the same
  double language = 1;   ///< exponent of the probabilities of pairs
  double insertion = 1;  ///< factor of every new phone
};

/// A frame of each path is a phone; index of SoundModel::phones.
using Path = std::vector<std::uint8_t>;

/// Frames go in one by one; what is older than `forget()` says is gone.
class PhonePaths {
 public:
  /// `pairs` as of read_phone_pairs().
  PhonePaths(const SoundModel& model, std::vector<double> pairs, const PathOptions& options);
  /// The scores of the next frame.
  void push(std::span<const float> scores);
  /// Frames so far.
  std::size_t frames() const { return first_ + past_.size(); }
  /// The first frame that is not forgotten.
  std::size_t first() const { return first_; }
  /// Path `number` from frame `from` to frames() - 1, drawn at random. The random numbers belong to
  /// path and frame: drawn again when more is known, a path stays as it is where that changes
  /// nothing.
  Path draw(std::size_t from, std::uint64_t number) const;
  /// Nothing before this frame will be asked for.
  void forget(std::size_t before);

 private:
  std::size_t phones_;
  PathOptions options_;
  std::vector<double> pairs_;  // to, from: with language and insertion
  std::vector<float> stay_;
  std::size_t first_ = 0;
  std::deque<std::vector<float>> past_;  // of each frame, phone and state
};

}  // namespace animeme::voice
