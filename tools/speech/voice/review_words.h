/// @file
/// A second look at the words of a path: which are there only because the text has them? Internal.
/// Source: tools/speech/voice/engines.md, section 1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tools/speech/voice/word_paths.h"

namespace animeme::voice {

/// Numbers of the words that are squeezed in between others, faster than anybody says them, where
/// the sound is better without them. Weak words are always said like that, so none of them.
std::vector<std::size_t> squeezed_words(const SoundModel& model, const FrameScores& scores,
                                        std::span<const WordModel> words,
                                        std::span<const PathPart> parts, const PathCosts& costs);

}  // namespace animeme::voice
