/// @file
/// Splits a text without spaces into words, with the voice input for each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::text {

/// A word of a transcript.
struct WordReading {
  std::string text;     ///< as written
  std::string reading;  ///< pinyin or kana for the voice; else the word itself
};

/// Whether a supported language is written without spaces: Chinese and Japanese (zh, cmn, ja, in
/// any case, with region or variant).
bool has_unparted_words(std::string_view language);

/// Splits a Chinese or Japanese text into words; Japanese particles stay with the preceding word.
/// Punctuation is removed. Without ICU, and for other languages, the text is one word.
/// Errors: those of japanese_words().
Result<std::vector<WordReading>> word_readings(std::string_view text, std::string_view language);

}  // namespace animeme::text
