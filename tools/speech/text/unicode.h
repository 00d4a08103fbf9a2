/// @file
/// Unicode and locale data (CLDR) of characters and languages: scripts, alphabets, spelling of
/// numbers, dates, amounts. Uses ICU (Debian package libicu-dev), an optional part of the build
/// (ANIMEME_WITH_ICU). Without it unicode_here() is false, each character is of script "Zyyy", and
/// the functions that produce text return empty results.
///
/// Languages are tags as "de" or "en-US", or codes of espeak-ng ("cmn", "en-us"). Scripts are ISO
/// 15924 codes: "Latn", "Cyrl", "Hani"; "Zyyy" is common, "Zinh" inherited from the previous
/// letter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// True if this build has ICU.
bool unicode_here();

/// Kinds of characters.
enum class Kind : std::uint8_t {
  letter,
  mark,         ///< combines with the previous letter
  digit,        ///< of any script
  blank,        ///< also line ends and control characters
  emoji,        ///< pictographs, joiners and modifiers
  symbol,       ///< © → ★, currencies, ASCII's + = ~ ...
  punctuation,  ///< everything else
};
/// The kind of a character.
Kind kind_of(char32_t code);

inline bool is_letter(char32_t code) { return kind_of(code) == Kind::letter; }  ///< without marks
inline bool is_blank(char32_t code) { return kind_of(code) == Kind::blank; }    ///< also controls
/// A letter or digit.
inline bool is_letter_or_digit(char32_t code) {
  return is_letter(code) || kind_of(code) == Kind::digit;
}

/// A vowel that is written as a sign at the letter before it ("ี" of Thai, "ि" of Hindi). Without
/// ICU none is known.
bool is_vowel_sign(char32_t code);

/// 0..9 of a digit of any script, -1 of anything else.
int digit_value(char32_t code);

/// A letter in lower case; other characters unchanged.
char32_t lower(char32_t code);

/// ISO 15924 code of a character.
std::string script_of(char32_t code);

/// "Cyrillic", "Chinese" (for Hani), "Greek"; the code if there is no name.
std::string script_name(std::string_view script);

/// The scripts that a language is written in, by CLDR; likely ones if it has no data; empty if
/// unknown. Japanese has Hani, Hira, Kana. A script in the tag ("fa-latn") takes precedence.
std::vector<std::string> scripts_of_language(std::string_view language);

/// The language that is most often written in a script, "ru" for "Cyrl"; empty if unknown.
std::string language_of_script(std::string_view script);

/// "Russian" for "ru"; the tag if there is no name.
std::string language_name(std::string_view language);

/// The three-letter code in ISO 639-2 (terminological) or 639-3 for media files: "deu" for "de-at",
/// "zho" for "cmn"; "und" (not determined) if unknown.
std::string language_code(std::string_view language);

/// The letters of a language (CLDR's exemplar characters), each as one string: some are several
/// code points. Lower case if there is case. Empty if CLDR has no data.
std::vector<std::u32string> letters_of_language(std::string_view language);

/// Converts a traditional Chinese character to simplified; others are unchanged.
char32_t simplified(char32_t code);
/// The inverse.
char32_t traditional(char32_t code);

/// Pinyin of one Chinese character with its tone as a number, "hao3" (5: no tone), by the most
/// usual reading. Empty for anything else.
std::string pinyin_of(char32_t code);

/// Forms of spelled numbers.
enum class NumberForm : std::uint8_t {
  cardinal,          ///< "one hundred forty-two"
  ordinal_digits,    ///< "142nd"
  ordinal,           ///< "forty-second"; masculine where a language has genders, without an ending
                     ///< for cases ("vierte")
  ordinal_feminine,  ///< "segunda"; as ordinal where there are no genders
  cardinal_and,      ///< "one hundred and forty-two"; as cardinal but in English
  year,              ///< "nineteen eighty-four"; as cardinal where years are read so
};
/// Spells a number: "forty-two". `digits` is ASCII: "42", "3.5". Empty without data, and for
/// ordinals in languages whose data has none.
std::string spell_number(std::string_view digits, std::string_view language, NumberForm form);

/// A day with the name of its month in the order of the locale: "May 12, 2024", "12. Mai 2024".
/// Empty without data. Proleptic Gregorian; the values must be a valid date (is_date()).
std::string spell_date(int year, int month, int day, std::string_view language);

/// True for a day of the calendar, years 1..9999.
bool is_date(int year, int month, int day);

/// The order of day, month and year in numeric dates: "mdy", "dmy", "ymd".
std::string date_order(std::string_view language);

/// "5.20 US dollars", "20 degrees Celsius", "15 percent". `number` is ASCII with a point. `unit` is
/// a currency ("USD") or a CLDR unit ("celsius", "kilometer-per-hour", "percent"). Empty without
/// data.
std::string spell_amount(std::string_view number, std::string_view unit, std::string_view language);

/// The decimal point of a language: '.' or ','.
char decimal_point(std::string_view language);

/// Whether thousands are separated by blanks: 100 000.
bool groups_by_blank(std::string_view language);

}  // namespace animeme::text
