/// @file
/// What espeak-ng means where the IPA that it writes is not what its voice says. Internal.
#pragma once

#include <string>
#include <string_view>

namespace animeme::voice {

/// The IPA of an event of a voice, by the voice's identifier ("zle/ru", "zle/ru-LV+f3"); as it is
/// where nothing is known to be wrong. espeak-ng writes the name of a phoneme where its data give
/// no IPA for it: y for the unrounded vowel of Russian, sx for the fricative of Swedish sju.
std::string meant_ipa(std::string_view voice, std::string_view written);

}  // namespace animeme::voice
