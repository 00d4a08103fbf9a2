/// @file
/// Which voice a user means. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// What a name stands for.
struct ChosenVoice {
  std::string identifier;  ///< for espeak-ng, with variant: "gmw/en-US+f3"
  std::string name;        ///< "English (America)"
  std::string language;    ///< "en-us"
};

/// The voices of VoiceOptions::language.
struct ChosenVoices {
  std::vector<ChosenVoice> voices;  ///< the main one first; none: "auto"
  std::string variant;              ///< "+f3"; empty: none
  bool automatic = false;           ///< further ones by script
};

/// The rules of VoiceOptions::language. Error: not_found, naming the nearest languages.
Result<ChosenVoices> choose_voices(std::string_view wanted, const VoiceLists& lists);

/// One of them alone, with a variant of choose_voices() or none. Errors as there.
Result<ChosenVoice> choose_voice(std::string_view language, std::string_view variant,
                                 const VoiceLists& lists);

}  // namespace animeme::voice
