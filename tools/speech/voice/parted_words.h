/// @file
/// The words of a transcript in any language. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/readings.h"

namespace animeme::voice {

/// The words of a transcript: those of split_words(), without readings, and what is said in several
/// ways with these (text::tokens_with_readings()). Chinese and Japanese, which have no blanks
/// between words, by their dictionaries. Errors: those of text::word_readings().
Result<std::vector<text::Token>> parted_words(std::string_view text, const std::string& language);

}  // namespace animeme::voice
