/// @file
/// The best path of a text through a sound: words in order, with pauses, with words that are not
/// said and speech that is not in the text. Internal. Source: tools/speech/voice/engines.md,
/// section 1.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tools/speech/voice/frame_scores.h"

namespace animeme::voice {

/// Behind the last variant.
inline constexpr std::size_t kNoVariant = ~std::size_t(0);

/// A word as the search wants it: ways to say it, in phones of the model.
struct WordModel {
  /// None: any sound at all, or nothing. Silence inside of one stands between the words of a
  /// reading ("twelve euros fifty") and may be left out.
  std::vector<std::vector<std::uint8_t>> variants;
  std::size_t complete = kNoVariant;  ///< those behind leave out a word of it
  float words = 1;        ///< that it is said with: to leave it out costs as much as them
  bool weak = false;      ///< often said with less than its sounds, as "with", "at"
  bool left_out = false;  ///< known not to be spoken
};

/// What is paid, in logarithms of likelihoods (which are far too sure of themselves).
struct PathCosts {
  float pause = 46;         ///< between words, once; also between those of a reading
  float skip = 60;          ///< before words that are not said, once
  float skip_word = 10;     ///< each of them
  float foreign = 60;       ///< before sound that the text does not have, once
  float foreign_frame = 3;  ///< a frame of it
  float unknown_frame = 2;  ///< a frame of a word without a pronunciation
};

/// Silence, a sound of a word, a sound of none.
enum class PartKind { pause, phone, foreign };

/// A stretch of the path.
struct PathPart {
  PartKind kind = PartKind::pause;  ///< what it is
  std::size_t first = 0;            ///< frame
  std::size_t frames = 0;           ///< that it takes
  std::size_t word = 0;     ///< of phones, pauses inside of it, and foreign sound that is it
  std::size_t variant = 0;  ///< of phones: the way to say the word
  std::size_t index = 0;    ///< of phones: their number in it
  float score = 0;          ///< sum over its frames
};

/// No word.
inline constexpr std::size_t kNone = ~std::size_t(0);

/// What find_path() finds.
struct FoundPath {
  std::vector<PathPart> parts;  ///< one behind the other
  float total = 0;              ///< what all frames score, less the costs
};

/// Finds it. With an open end words may be left over behind the sound at no cost. Empty if the
/// sound has no frames.
FoundPath find_path(const SoundModel& model, const FrameScores& scores,
                    std::span<const WordModel> words, const PathCosts& costs, bool open_end);

}  // namespace animeme::voice
