/// @file
/// The words of a transcript that people say in several ways: "1984", "$500", "3/4", "50 %",
/// "9:30", "Dr.", "VIII", with these ways, for an aligner that picks the one that it hears.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// The most ways to say one token.
inline constexpr std::size_t kMostReadings = 12;

/// What stands between blanks in a transcript, or several parts that are read as one: "50 %",
/// "1 234", "z. B.", "9:30 Uhr".
struct Token {
  std::string text;  ///< as written, without punctuation around it
  /// The ways to say it, at most kMostReadings, in words and letters; the first one may have digits
  /// and is what a voice says for the text (written.h). Empty for what consists of letters and is
  /// said as it is written.
  std::vector<std::string> readings;
  /// Of the readings, how many say all of the token; the others, behind them, leave out the
  /// currency: "five hundred" for "$500".
  std::size_t complete = 0;
};

/// The tokens of a text (UTF-8) in order. What has no letter, digit or sign that is said is left
/// out. Readings with words between the numbers are known for en, de, fr, es, it, pt, nl; other
/// languages have cardinals and digits, and what written.h knows. Without ICU no token has
/// readings. Takes a time that is linear in the length of the text.
std::vector<Token> tokens_with_readings(std::string_view text, const std::string& language);

}  // namespace animeme::text
