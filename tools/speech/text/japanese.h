/// @file
/// Converts Japanese to kana for espeak-ng's voice ja, with MeCab and its dictionary IPAdic.
///
/// The library (Debian package libmecab-dev) is an optional part of the build (ANIMEME_WITH_MECAB),
/// the dictionary (mecab-ipadic-utf8) is needed at run time. Text in kana alone needs neither.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// Debian's location of the dictionary.
inline constexpr const char* kJapaneseFolder = "/var/lib/mecab/dic/ipadic-utf8";

/// A word of a Japanese text.
struct JapaneseWord {
  /// characters, from 0, one behind
  std::size_t first = 0, last = 0;  ///< characters of the text
  std::u32string kana;  ///< as it is spoken: ワ for は as a particle; empty: no reading
  bool leans = false;   ///< a particle or ending, spoken with the word before it
};

/// Splits a text into words, without blanks. Errors: unsupported (built without MeCab), not_found
/// (no dictionary), both naming the package.
Result<std::vector<JapaneseWord>> japanese_words(std::u32string_view text,
                                                 const std::string& folder = kJapaneseFolder);

/// Converts words to kana and numbers to Japanese words; everything else is unchanged. Long vowels
/// are doubled, as espeak-ng 1.51 ignores the length mark. Characters without a reading are removed
/// and added to `unread`. Errors: those of japanese_words(), unless the text is all kana.
Result<SpokenText> read_japanese(const SpokenText& said, std::u32string& unread,
                                 const std::string& folder = kJapaneseFolder);

}  // namespace animeme::text
