/// @file
/// Japanese as kana, as espeak-ng's voice ja reads it, by MeCab and its dictionary IPAdic.
///
/// The library (Debian package libmecab-dev) is an optional part of the build (ANIMEME_WITH_MECAB),
/// the dictionary (mecab-ipadic-utf8) has to be there at run time. Kana alone needs neither.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/said.h"

namespace animeme::text {

/// Where Debian puts the dictionary.
inline constexpr const char* kJapaneseFolder = "/var/lib/mecab/dic/ipadic-utf8";

/// A word of a Japanese text.
struct JapaneseWord {
  /// characters, from 0, one behind
  std::size_t first = 0, last = 0;  ///< characters of the text
  std::u32string kana;  ///< as it is spoken: ワ for は as a particle; empty: no reading
  bool leans = false;   ///< a particle or ending, spoken with the word before it
};

/// The words of a text in order; blanks are none. Errors: unsupported (built without MeCab),
/// not_found (no dictionary), both naming the package.
Result<std::vector<JapaneseWord>> japanese_words(std::u32string_view text,
                                                 const std::string& folder = kJapaneseFolder);

/// Words become kana, numbers are read in Japanese, all the rest stays. Long vowels are written
/// twice, as espeak-ng 1.51 drops the sign for length. Characters without a reading are left out
/// and named in `unread`. Errors: those of japanese_words(), if there is anything but kana.
Result<Said> read_japanese(const Said& said, std::u32string& unread,
                           const std::string& folder = kJapaneseFolder);

}  // namespace animeme::text
