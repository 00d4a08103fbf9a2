/// @file
/// The language that a text is written in, by its words: for languages that share an alphabet. By
/// CLD2 (Debian package libcld2-dev), an optional part of the build (ANIMEME_WITH_CLD2). Without it
/// can_guess() is false and nothing is guessed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// True if this build can guess.
bool can_guess();

/// The language of most of a text, as a code that espeak-ng's voices have: "fr", "pt", "nb",
/// "cmn". Empty where it is not sure: less than two words and seven letters, or words that several
/// languages have ("mama papa"). Names and single words are often guessed wrong, so a caller
/// should ask for sentences and keep what it knows where this is empty.
std::string guess_language(std::u32string_view text);

/// The language of each character, sentence by sentence: a sentence of less than twelve letters is
/// taken to be in the language of the whole. Empty where guess_language() is not sure of either.
std::vector<std::string> guess_sentences(std::u32string_view text);

}  // namespace animeme::text
