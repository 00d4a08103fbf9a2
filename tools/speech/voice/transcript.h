/// @file
/// The words of a transcript. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::voice {

/// Without punctuation at both ends (ASCII, and that of Unicode's general block); apostrophes
/// stay only inside.
std::string_view strip_punctuation(std::string_view word);

/// Words in order, as written but without punctuation; hyphens and dashes part words. Curly
/// apostrophes become straight ones. `text` is UTF-8.
std::vector<std::string> split_words(std::string_view text);

}  // namespace animeme::voice
