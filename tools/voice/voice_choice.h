/// @file
/// Which voice a user means. Internal.
#pragma once

#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/voice/espeak_process.h"

namespace animeme::voice {

/// What a name stands for.
struct ChosenVoice {
  std::string identifier;  ///< for espeak-ng, with variant: "gmw/en-US+f3"
  std::string name;        ///< "English (America)"
};

/// The rules of VoiceOptions::language. Error: not_found, naming the nearest languages.
Result<ChosenVoice> choose_voice(std::string_view wanted, const VoiceLists& lists);

}  // namespace animeme::voice
