/// @file
/// Whether a voice reads the alphabet of its own language.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {

/// How a voice reads the letters of its language.
struct LetterCounts {
  std::size_t letters = 0;           ///< number tested; 0: CLDR has no data for the language
  std::size_t spoken = 0;            ///< in the voice's own language
  std::vector<std::string> foreign;  ///< the other letters
};

/// Tries each letter of the language of a voice (CLDR's exemplar characters; of more than 400 every
/// second, third ...). Combining marks follow a letter. A letter counts as spoken if the voice says
/// something without switching to another language.
/// Errors: those of speak_text() about options and voices.
Result<LetterCounts> count_letters(const VoiceOptions& options = {});

}  // namespace animeme::voice
