// Roman numerals. Inside of written.cpp and transcript_words.cpp.
#pragma once

#include <string>
#include <string_view>

#include "tools/speech/text/amounts_internal.h"

namespace animeme::text {

/// The value of a numeral of I, V, X and L as it is written today ("XIV", not "XIIII"), 1..89; 0
/// for anything else. Without L up to three letters are too often sizes and names.
int roman_value(std::u32string_view token);

/// What is said for a numeral that begins at `at`, where no letter or digit is before: "the eighth"
/// behind the name of a king, "four" behind "chapter". `end` is 0 if there is none, if it may be
/// a word or an abbreviation ("I", "an IV drip"), or if the voices of the language read it well.
Amount roman_at(std::u32string_view text, std::size_t at, const std::string& language,
                std::string_view base);

}  // namespace animeme::text
