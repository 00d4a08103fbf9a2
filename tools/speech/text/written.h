/// @file
/// Normalises written text for speech: dates, times, amounts, telephone numbers, web addresses,
/// repeated punctuation, emoji. What espeak-ng reads well in a language is unchanged.
#pragma once

#include <string>
#include <string_view>

#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// Options for normalisation.
struct Writing {
  std::string language = "en-us";  ///< order of dates, decimal point, names of units
  bool keep_emoji = false;         ///< the voice names emoji; else they are removed
  bool spell_digits = false;       ///< spell numbers, for voices that do not read digits
};

/// Normalises a text:
///
/// - 12/05/2024, 2024-05-12, 12.5.24: a day with the name of its month, in the order of the
///   language; if that is not a valid date, the other way round.
/// - $5.20, 5 EUR, 20 °C, 60 km/h: number and unit name.
/// - +1 555 123-4567: digit by digit, with pauses.
/// - 3:45pm: "3:45 p m" in English; https://x.y/z: "x.y", a pause, "z".
/// - "!!!", "...", "?!" become one sign after the word; *, _, ~, |, \, #, <, > etc. are removed, as
/// are emoji.
///
/// Everything else is unchanged; without ICU, all of the text is.
SpokenText read_written(const SpokenText& said, const Writing& writing);

/// Whether there is a letter or digit to speak: "!!! 😀" has none.
bool has_words(std::u32string_view text);

/// Whether the characters first..last are the symbol of a unit or currency that follows a number:
/// "km/h", "kg", "EUR"; also "am" and "pm".
bool is_unit(std::u32string_view text, std::size_t first, std::size_t last);

}  // namespace animeme::text
