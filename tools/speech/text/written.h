/// @file
/// From what is written to what is said: dates, times, amounts, telephone numbers, addresses of the
/// web, rows of punctuation, pictures. What espeak-ng reads well in a language is left to it.
#pragma once

#include <string>
#include <string_view>

#include "tools/speech/text/said.h"

namespace animeme::text {

/// How a text is read.
struct Writing {
  std::string language = "en-us";  ///< order of dates, decimal point, names of units
  bool keep_emoji = false;         ///< pictures are named by the voice; else left out
  bool spell_digits = false;       ///< numbers in words, for voices that say none
};

/// What is said for a text:
///
/// - 12/05/2024, 2024-05-12, 12.5.24: a day with the name of its month, in the order of the
///   language; where that is no day, the other way round.
/// - $5.20, 5 EUR, 20 °C, 60 km/h: number and name of the unit.
/// - +1 555 123-4567: digit by digit, with pauses.
/// - 3:45pm: "3:45 p m" in English; https://x.y/z: "x.y", a pause, "z".
/// - "!!!", "...", "?!" are one sign at the word before; *, _, ~, |, \, #, <, > and their like are
///   left out, as are pictures.
///
/// All the rest stays, character for character. Without ICU everything does.
Said read_written(const Said& said, const Writing& writing);

/// True if a letter or digit would be spoken: "!!! 😀" has none.
bool has_words(std::u32string_view text);

/// True if the characters from `first` on are the sign of a unit or currency that follows a number,
/// up to its end: "km/h", "kg", "EUR"; also "am" and "pm".
bool is_unit(std::u32string_view text, std::size_t first, std::size_t last);

}  // namespace animeme::text
