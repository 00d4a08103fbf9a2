/// @file
/// The words of a text that has no blanks between them, with what a voice is to be given for each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::text {

/// A word of a transcript.
struct WordReading {
  std::string text;     ///< as it is written
  std::string reading;  ///< pinyin or kana, for the voice that reads them; else the word itself
};

/// True for languages that are written without blanks and are read here: Chinese and Japanese (zh,
/// cmn, ja, in any case, with region or variant).
bool has_unparted_words(std::string_view language);

/// Parts a Chinese or Japanese text into words; Japanese particles stay with the word before them.
/// Punctuation is left out. Without ICU, and for other languages, the text is one word.
/// Errors: those of japanese_words().
Result<std::vector<WordReading>> word_readings(std::string_view text, std::string_view language);

}  // namespace animeme::text
