// In place of unicode_icu.cpp and locale_icu.cpp: in the program, and where ICU was not there at
// build time.
#include <type_traits>
#include <utility>

#include "tools/speech/text/late_internal.h"

namespace animeme::text {
namespace {

// The answer of the module; that of a build without ICU where it does not load.
template <class Answer, class... Arguments>
Answer ask(Answer (*TextFunctions::*function)(Arguments...), std::type_identity_t<Answer> otherwise,
           std::type_identity_t<Arguments>... arguments) {
  const auto& module = late_text();
  return module ? ((*module)->*function)(arguments...) : std::move(otherwise);
}

using F = TextFunctions;

Kind ascii_kind(char32_t code) {
  if (code <= U' ' || code == 0x7F || code == 0xA0) return Kind::blank;
  if (code >= U'0' && code <= U'9') return Kind::digit;
  const bool ascii = code < 0x80;
  const bool letter = (code >= U'a' && code <= U'z') || (code >= U'A' && code <= U'Z');
  return ascii && !letter ? Kind::punctuation : Kind::letter;
}

}  // namespace

bool unicode_here() { return ask(&F::unicode_here, false); }
Kind kind_of(char32_t code) { return ask(&F::kind_of, ascii_kind(code), code); }
bool is_vowel_sign(char32_t code) { return ask(&F::is_vowel_sign, false, code); }
int digit_value(char32_t code) {
  return ask(&F::digit_value, code >= U'0' && code <= U'9' ? int(code - U'0') : -1, code);
}
char32_t lower(char32_t code) { return ask(&F::lower, code, code); }
std::string script_of(char32_t code) { return ask(&F::script_of, std::string("Zyyy"), code); }
std::string script_name(std::string_view script) {
  return ask(&F::script_name, std::string(script), script);
}
std::vector<std::string> scripts_of_language(std::string_view language) {
  return ask(&F::scripts_of_language, {}, language);
}
std::string language_of_script(std::string_view script) {
  return ask(&F::language_of_script, {}, script);
}
std::string language_name(std::string_view language) {
  return ask(&F::language_name, std::string(language), language);
}
std::string language_code(std::string_view language) {
  return ask(&F::language_code, std::string("und"), language);
}
std::vector<std::u32string> letters_of_language(std::string_view language) {
  return ask(&F::letters_of_language, {}, language);
}
char32_t simplified(char32_t code) { return ask(&F::simplified, code, code); }
char32_t traditional(char32_t code) { return ask(&F::traditional, code, code); }
std::string pinyin_of(char32_t code) { return ask(&F::pinyin_of, {}, code); }
std::string spell_number(std::string_view digits, std::string_view language, NumberForm form) {
  return ask(&F::spell_number, {}, digits, language, form);
}
std::string spell_date(int year, int month, int day, std::string_view language) {
  return ask(&F::spell_date, {}, year, month, day, language);
}
bool is_date(int year, int month, int day) { return ask(&F::is_date, false, year, month, day); }
std::string date_order(std::string_view language) {
  return ask(&F::date_order, std::string("dmy"), language);
}
std::string spell_amount(std::string_view number, std::string_view unit,
                         std::string_view language) {
  return ask(&F::spell_amount, {}, number, unit, language);
}
char decimal_point(std::string_view language) { return ask(&F::decimal_point, '.', language); }
bool groups_by_blank(std::string_view language) {
  return ask(&F::groups_by_blank, false, language);
}

}  // namespace animeme::text
