/// @file
/// The words of a text in a sound of any length: in pieces, by find_path(). Internal.
/// Source: tools/speech/voice/engines.md, section 1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/speech/voice/word_paths.h"

namespace animeme::voice {

/// A part of the path, with frames of the whole sound.
struct PlacedPart {
  PathPart part;                    ///< what it is
  std::vector<std::uint8_t> heard;  ///< of foreign sound: the phone of each frame
};

/// What a text amounts to in a sound.
struct Placement {
  std::vector<PlacedPart> parts;  ///< one behind the other
  /// How far the path is from that of a text of which nothing is said, 0, to a perfect one, 1: how
  /// much of what the sound costs without the text the text saves.
  double explained = 0;
};

/// Places them. `foreign` words are said by rules for a model of another language: they may fit
/// badly, and are not left out as easily. More than a minute is taken in pieces that end in pauses:
/// the search costs as much as there are states times frames, and where a path is lost it is found
/// again. Foreign sound that is short, or quiet beside the voice, is a pause. Memory: 10 MB, and
/// some of the words.
Placement place_words(const SoundModel& model, const MeasuredSound& sound,
                      std::span<const WordModel> words, bool foreign);

}  // namespace animeme::voice
