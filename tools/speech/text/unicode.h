/// @file
/// What Unicode and its locale data (CLDR) know of characters and languages: scripts, alphabets,
/// names of numbers, dates, amounts. By ICU (Debian package libicu-dev), an optional part of the
/// build (ANIMEME_WITH_ICU). Without it unicode_here() is false, each character is of script
/// "Zyyy", and the functions that make text return nothing.
///
/// Languages are tags as "de" or "en-US", or codes of espeak-ng ("cmn", "en-us"). Scripts are ISO
/// 15924 codes: "Latn", "Cyrl", "Hani"; "Zyyy" is common to all, "Zinh" that of the letter before.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// True if this build has ICU.
bool unicode_here();

/// What kind of character it is.
enum class Kind : std::uint8_t {
  letter,
  mark,         ///< belongs to the letter before
  digit,        ///< of any script
  blank,        ///< also line ends and control characters
  emoji,        ///< pictures, and what joins and colours them
  symbol,       ///< © → ★, currencies, ASCII's + = ~ ...
  punctuation,  ///< all the rest
};
/// The kind of a character.
Kind kind_of(char32_t code);

inline bool is_letter(char32_t code) { return kind_of(code) == Kind::letter; }  ///< without marks
inline bool is_blank(char32_t code) { return kind_of(code) == Kind::blank; }    ///< also controls
/// A letter or digit.
inline bool is_letter_or_digit(char32_t code) {
  return is_letter(code) || kind_of(code) == Kind::digit;
}

/// 0..9 of a digit of any script, -1 of anything else.
int digit_value(char32_t code);

/// A letter as a small one; anything else as it is.
char32_t lower(char32_t code);

/// ISO 15924 code of a character.
std::string script_of(char32_t code);

/// "Cyrillic", "Chinese" (for Hani), "Greek"; the code where there is no name.
std::string script_name(std::string_view script);

/// The scripts that a language is written in, by CLDR; likely ones where it has no data; empty if
/// unknown. Japanese has Hani, Hira, Kana. A script in the tag ("fa-latn") is the answer.
std::vector<std::string> scripts_of_language(std::string_view language);

/// The language that is most often written in a script, "ru" for "Cyrl"; empty if unknown.
std::string language_of_script(std::string_view script);

/// "Russian" for "ru"; the tag where there is no name.
std::string language_name(std::string_view language);

/// Its three letters in ISO 639-2 (terminological) or 639-3, as media files name it: "deu" for
/// "de-at", "zho" for "cmn"; "und" (not determined) if unknown.
std::string language_code(std::string_view language);

/// The letters of a language (CLDR's exemplar characters), each as one string: some are several
/// code points. Lower case where there is case. Empty where CLDR has no data of it.
std::vector<std::u32string> letters_of_language(std::string_view language);

/// A traditional Chinese character as a simplified one; others as they are.
char32_t simplified(char32_t code);
/// And back.
char32_t traditional(char32_t code);

/// Pinyin of one Chinese character with its tone as a number, "hao3" (5: no tone), by the most
/// usual reading. Empty for anything else.
std::string pinyin_of(char32_t code);

/// How a number is spelled out.
enum class NumberForm : std::uint8_t { cardinal, ordinal_digits };
/// "forty-two"; for ordinal_digits "42nd". `digits` is ASCII: "42", "3.5". Empty without data.
std::string spell_number(std::string_view digits, std::string_view language, NumberForm form);

/// A day with the name of its month in the order of the locale: "May 12, 2024", "12. Mai 2024".
/// Empty without data. Proleptic Gregorian; the values have to be a date (is_date()).
std::string spell_date(int year, int month, int day, std::string_view language);

/// True for a day of the calendar, years 1..9999.
bool is_date(int year, int month, int day);

/// The order of day, month and year where all are numbers: "mdy", "dmy", "ymd".
std::string date_order(std::string_view language);

/// "5.20 US dollars", "20 degrees Celsius", "15 percent". `number` is ASCII with a point. `unit` is
/// a currency ("USD") or a CLDR unit ("celsius", "kilometer-per-hour", "percent"). Empty without
/// data.
std::string spell_amount(std::string_view number, std::string_view unit, std::string_view language);

/// The decimal point of a language: '.' or ','.
char decimal_point(std::string_view language);

/// Whether thousands are parted by blanks: 100 000.
bool groups_by_blank(std::string_view language);

}  // namespace animeme::text
