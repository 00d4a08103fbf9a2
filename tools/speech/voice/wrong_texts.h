/// @file
/// Texts that nobody said, to compare with one that fits badly: noise makes all of them fit badly,
/// and the right one still best. Internal.
#pragma once

#include <vector>

#include "tools/speech/voice/word_paths.h"

namespace animeme::voice {

/// As many texts are made of each.
inline constexpr std::size_t kWrongTexts = 6;

/// The words with other phones, vowels for vowels and consonants for consonants: as long, and as
/// easy to say. `number` is below kWrongTexts.
std::vector<WordModel> wrong_text(const SoundModel& model, const std::vector<WordModel>& words,
                                  std::size_t number);

}  // namespace animeme::voice
