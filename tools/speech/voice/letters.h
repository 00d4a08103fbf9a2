/// @file
/// Whether a voice reads the alphabet of its own language.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {

/// Letters of a language and what its voice makes of them.
struct LetterCounts {
  std::size_t letters = 0;           ///< that were tried; 0: CLDR has no data of the language
  std::size_t spoken = 0;            ///< in the voice's own language
  std::vector<std::string> foreign;  ///< the others, as they are written
};

/// Tries each letter of the language of a voice (CLDR's exemplar characters; of more than 400 every
/// second, third ...). Marks stand behind a letter. A letter is spoken if the voice says something
/// and does not change to another language for it.
/// Errors: those of speak_text() about options and voices.
Result<LetterCounts> count_letters(const VoiceOptions& options = {});

}  // namespace animeme::voice
