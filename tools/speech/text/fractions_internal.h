// Fractions and ordinals in figures. Inside of written.cpp and of the readings of transcripts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/speech/text/amounts_internal.h"

namespace animeme::text {

/// "two thirds", "three quarters", "half"; for 3/4 in English also "three fourths". Empty for a
/// language without names of fractions here. 0 < top < bottom.
std::vector<std::u32string> fraction_words(int top, int bottom, const std::string& language,
                                           std::string_view base);

/// "one and a half", "zwei drei Viertel". Empty as fraction_words().
std::u32string mixed_words(std::string_view whole, int top, int bottom, const std::string& language,
                           std::string_view base);

/// Top and bottom of ½, ⅓ ...; 0 and 0 for anything else.
struct Fraction {
  int top = 0, bottom = 0;
};
Fraction fraction_sign(char32_t c);

/// What is said for the fraction or mixed number that begins at `at`, where no letter or digit is
/// before: 2/3, 1 1/2, ¾, 2½. `end` is 0 for what is none: 24/7, 9/11, 1/2/2024, 3/4 time.
Amount fraction_at(std::u32string_view text, std::size_t at, const std::string& language,
                   std::string_view base);

/// What is said for an ordinal in figures, where the voices read another thing: "2. Mai",
/// "der 3. Mann", "2e étage", "1.º". `end` is 0 for anything else.
Amount ordinal_at(std::u32string_view text, std::size_t at, const std::string& language,
                  std::string_view base);

/// The German ordinal of a day by the word before: "am zwölften Mai", "der zwölfte Mai", else
/// "zwölfter Mai".
std::u32string german_ordinal(int value, std::string_view before);

}  // namespace animeme::text
