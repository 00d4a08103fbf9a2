/// @file
/// How sure an alignment is of each phone and word, from what its search and a free search scored.
/// Internal.
#pragma once

#include <vector>

#include "tools/speech/voice/align.h"
#include "tools/speech/voice/recogniser.h"

namespace animeme::voice {

/// Of a phone: its score on the scale of AlignedWord::confidence.
double rate_phone(const Segment& segment);

/// All words with their times and confidences, in order. Those that are not said are where they
/// would be.
std::vector<AlignedWord> rate_words(const std::vector<Segment>& segments,
                                    const std::vector<SpokenWord>& words, double duration);

/// Of the recording, 0..1. Words of other languages than English fit less well.
double rate_recording(const Recognised& found, const std::vector<SpokenWord>& words, bool english);

}  // namespace animeme::voice
