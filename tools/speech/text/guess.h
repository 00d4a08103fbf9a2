/// @file
/// Detects the language of a text by its words, for languages that share an alphabet, with CLD2
/// (Debian package libcld2-dev), an optional part of the build (ANIMEME_WITH_CLD2). Without it
/// can_guess() is false and nothing is detected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// Whether this build has language detection.
bool can_guess();

/// The language of most of a text, as a code that espeak-ng's voices have: "fr", "pt", "nb", "cmn".
/// Empty if uncertain: less than two words and seven letters, or words of several languages ("mama
/// papa"). Names and single words are often detected wrongly, so callers should pass sentences and
/// keep their default if the result is empty.
std::string guess_language(std::u32string_view text);

/// The language of each character, sentence by sentence: a sentence of less than twelve letters is
/// taken to be in the language of the whole. Empty if guess_language() is uncertain about both.
std::vector<std::string> guess_sentences(std::u32string_view text);

}  // namespace animeme::text
