// The ways to say one token. Inside of readings.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/speech/text/spoken_numbers_internal.h"

namespace animeme::text {

/// Ways to say a token, the likeliest first.
struct WaysToSay {
  std::vector<std::string> complete;  ///< all of it
  std::vector<std::string> short_of;  ///< without the currency
};

/// All ways, without those of the text front end. `token` is as written, with
/// digits as ASCII, blanks as U+0020, and dashes between digits as hyphens. `front` is what the
/// front end says for it. Empty if the token is an ordinary word.
WaysToSay ways_to_say(std::string_view token, std::string_view front, const std::string& language,
                      const SpokenNumbers& numbers);

/// Numbers of a text of the front end in words: "5 dollars" as "five dollars".
std::string digits_in_words(std::string_view front, const SpokenNumbers& numbers, char point);

}  // namespace animeme::text
