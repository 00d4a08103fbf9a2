/// @file
/// From the events of a voice to a phoneme script. Internal.
#pragma once

#include <string_view>

#include "dam/script/script.h"
#include "tools/voice/espeak_process.h"

namespace animeme::voice {

/// The script of `raw`, whose samples include the silence added before (event samples are those
/// of the padded sound). `text` is what was spoken; words are cut out of it. Covers the sound
/// exactly; empty if there are no samples.
dam::Script make_voice_script(const RawSpeech& raw, int sample_rate, std::string_view text);

}  // namespace animeme::voice
