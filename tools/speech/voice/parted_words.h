/// @file
/// The words of a transcript in any language. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::voice {

/// split_words(); Chinese and Japanese, which have no blanks between words, by their dictionaries.
/// Errors: those of text::word_readings().
Result<std::vector<std::string>> parted_words(std::string_view text, std::string_view language);

}  // namespace animeme::voice
