/// @file
/// What espeak-ng means where the IPA that it writes is not what its voice says. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// The IPA of an event of a voice, by the voice's identifier ("zle/ru", "zle/ru-LV+f3"); as it is
/// where nothing is known to be wrong. espeak-ng writes the name of a phoneme where its data give
/// no IPA for it: y for the unrounded vowel of Russian, sx for the fricative of Swedish sju. `next`
/// is the IPA of the phoneme behind it: the moraic n of Japanese, which espeak-ng writes as a
/// nasal u, closes the lips before p, b and m alone, and never rounds them.
std::string meant_ipa(std::string_view voice, std::string_view written, std::string_view next = {});

/// The IPA of the phoneme behind an event; empty at the end.
std::string_view ipa_behind(const std::vector<VoiceEvent>& events, std::size_t at);

}  // namespace animeme::voice
