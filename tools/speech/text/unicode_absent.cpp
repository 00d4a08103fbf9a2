// Stands in for unicode_icu.cpp where the library was not there at build time.
#include "tools/speech/text/unicode.h"

namespace animeme::text {

bool unicode_here() { return false; }

Kind kind_of(char32_t code) {
  if (code <= U' ' || code == 0x7F || code == 0xA0) return Kind::blank;
  if (code >= U'0' && code <= U'9') return Kind::digit;
  const bool ascii = code < 0x80;
  const bool letter = (code >= U'a' && code <= U'z') || (code >= U'A' && code <= U'Z');
  return ascii && !letter ? Kind::punctuation : Kind::letter;
}

int digit_value(char32_t code) { return code >= U'0' && code <= U'9' ? int(code - U'0') : -1; }
char32_t lower(char32_t code) { return code; }
std::string script_of(char32_t) { return "Zyyy"; }
std::string script_name(std::string_view script) { return std::string(script); }
std::vector<std::string> scripts_of_language(std::string_view) { return {}; }
std::string language_of_script(std::string_view) { return {}; }
std::string language_name(std::string_view language) { return std::string(language); }
std::string language_code(std::string_view) { return "und"; }
std::vector<std::u32string> letters_of_language(std::string_view) { return {}; }
char32_t simplified(char32_t code) { return code; }
char32_t traditional(char32_t code) { return code; }
std::string pinyin_of(char32_t) { return {}; }
std::string spell_number(std::string_view, std::string_view, NumberForm) { return {}; }
std::string spell_date(int, int, int, std::string_view) { return {}; }
bool is_date(int, int, int) { return false; }
std::string date_order(std::string_view) { return "dmy"; }
std::string spell_amount(std::string_view, std::string_view, std::string_view) { return {}; }
char decimal_point(std::string_view) { return '.'; }
bool groups_by_blank(std::string_view) { return false; }

}  // namespace animeme::text
