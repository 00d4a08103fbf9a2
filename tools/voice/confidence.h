/// @file
/// How sure an alignment is of each word, from what its search and a free search scored. Internal.
#pragma once

#include <vector>

#include "tools/voice/align.h"
#include "tools/voice/recogniser.h"

namespace animeme::voice {

/// The words with their times and confidences, in order; those that got no time are not there.
std::vector<AlignedWord> rate_words(const std::vector<Segment>& segments,
                                    const std::vector<SpokenWord>& words, double duration);

/// Of the recording: the mean score of all frames of words on the scale of AlignedWord::confidence;
/// 0 without words.
double rate_recording(const std::vector<Segment>& segments);

}  // namespace animeme::voice
