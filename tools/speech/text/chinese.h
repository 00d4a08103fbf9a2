/// @file
/// Chinese characters to pinyin, as espeak-ng's voice cmn-latn-pinyin reads it.
///
/// Words and their syllables are those of Rime's dictionary pinyin_simp (Debian package
/// rime-data-pinyin-simp, 65,000 words), tones those of its terra_pinyin (rime-data-terra-pinyin).
/// If neither is installed, ICU reads each character separately: 银行 is then "yin xing".
/// Traditional characters are looked up by their simplified ones.
#pragma once

#include <string>
#include <vector>

#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// Debian's location of Rime's dictionaries.
inline constexpr const char* kRimeFolder = "/usr/share/rime-data";

/// A word of a Chinese text.
struct ChineseWord {
  /// characters, from 0, one behind
  std::size_t first = 0, last = 0;  ///< characters of the text
  std::string pinyin;               ///< "yin2hang2"; empty: not a Chinese word, or no reading
};

/// Splits a text into words and the pieces between them, in order.
std::vector<ChineseWord> chinese_words(std::u32string_view text,
                                       const std::string& folder = kRimeFolder);

/// Whether the dictionary of words is installed.
bool has_chinese_words(const std::string& folder = kRimeFolder);

/// Converts words to pinyin separated by blanks, and numbers to Chinese words; everything else is
/// unchanged. Characters without a reading are removed and added to `unread`.
SpokenText read_chinese(const SpokenText& said, std::u32string& unread,
                        const std::string& folder = kRimeFolder);

/// Digits of a Chinese or Japanese text as Chinese characters: 2024年 (in Chinese) 二〇二四年, 15%
/// 百分之十五, 3:45 三点四十五分, long numbers digit by digit.
SpokenText spell_han_numbers(const SpokenText& said, bool japanese);

}  // namespace animeme::text
