/// @file
/// From the events of a voice to a phoneme script. Internal.
#pragma once

#include <string_view>
#include <vector>

#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// The script of `raw`, which spoke `utterance`: words are those of its source. Its samples include
/// the silence added before (event samples are those of the padded sound). Covers the sound
/// exactly; empty if there are no samples.
dam::Script make_voice_script(const RawSpeech& raw, int sample_rate,
                              const text::Utterance& utterance);

/// The same of a text that was spoken as it is.
dam::Script make_voice_script(const RawSpeech& raw, int sample_rate, std::string_view text);

/// The moods of `utterance` by the times of its words in the sound; `script` is that of
/// make_voice_script().
std::vector<dam::MoodSpan> find_moods(const RawSpeech& raw, int sample_rate,
                                      const text::Utterance& utterance, const dam::Script& script);

/// The characters of the source that a word event names; both 0 if there are none.
text::Place place_of(const VoiceEvent& event, const text::Utterance& utterance);

}  // namespace animeme::voice
