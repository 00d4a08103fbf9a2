/// @file
/// What an alignment amounts to: its script, speech that is in no text, warnings. Internal.
#pragma once

#include <vector>

#include "tools/speech/voice/align.h"
#include "tools/speech/voice/recogniser.h"

namespace animeme::voice {

/// Fills Alignment::script and confidences; silences that touch are one.
void add_script(const std::vector<Segment>& segments, const std::vector<SpokenWord>& words,
                double duration, Alignment& alignment);

/// Fills Alignment::put_in.
void add_put_in(const std::vector<Segment>& segments, double duration, Alignment& alignment);

/// Says which words are not said, which speech the text does not have, and which words hardly fit.
void add_warnings(Alignment& alignment);

}  // namespace animeme::voice
