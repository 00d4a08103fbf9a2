// The functions of this library that ICU, MeCab and CLD2 do the work of, as a table of pointers.
// The program has the *_absent.cpp files in place of those that call these libraries: they ask the
// module animeme_text.so first, and do without where it does not load.
#pragma once

#include "fap/result.h"
#include "tools/speech/text/guess.h"
#include "tools/speech/text/japanese.h"
#include "tools/speech/text/unicode.h"

// clang-format off
#define ANIMEME_TEXT_FUNCTIONS(X) \
  X(can_guess) \
  X(date_order) \
  X(decimal_point) \
  X(digit_value) \
  X(groups_by_blank) \
  X(guess_language) \
  X(is_date) \
  X(is_vowel_sign) \
  X(japanese_words) \
  X(kind_of) \
  X(language_code) \
  X(language_name) \
  X(language_of_script) \
  X(letters_of_language) \
  X(lower) \
  X(pinyin_of) \
  X(script_name) \
  X(script_of) \
  X(scripts_of_language) \
  X(simplified) \
  X(spell_amount) \
  X(spell_date) \
  X(spell_number) \
  X(traditional) \
  X(unicode_here)
// clang-format on

namespace animeme::text {

struct TextFunctions {
#define ANIMEME_TEXT_MEMBER(name) decltype(&text::name) name;
  ANIMEME_TEXT_FUNCTIONS(ANIMEME_TEXT_MEMBER)
#undef ANIMEME_TEXT_MEMBER
};

/// The table. There are two definitions: the library has none to offer (not_built.cpp), the program
/// loads it with the first call (tools/app/late/text_late.cpp). Errors: unsupported, naming what to
/// install.
const Result<const TextFunctions*>& late_text();

}  // namespace animeme::text
