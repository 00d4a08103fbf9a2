/// @file
/// The words of a script with their times.
///
///     for (const ScriptWord& word : words_of(script)) show(word.text, word.start, word.end);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "dam/script/timings.h"

namespace animeme::dam {

/// A spoken word.
struct ScriptWord {
  double start = 0;       ///< seconds: start of its first phone
  double end = 0;         ///< seconds: end of its last phone
  std::string text;       ///< as Phone::word, not empty
  std::size_t first = 0;  ///< its phones in Script::phones: the first
  std::size_t last = 0;   ///< ... and one past the last; silence between them belongs to the word

  friend bool operator==(const ScriptWord&, const ScriptWord&) = default;
};

/// The words of a script in order. Phones in a row with the same word are one word, except as
/// Phone::link says. Phones without a word are in none.
std::vector<ScriptWord> words_of(const Script& script);

/// Sets Phone::link of the phone at `place`, which has a word, given the phones before it:
/// `begins_word` says whether another word begins with it.
void link_phone(std::vector<Phone>& phones, std::size_t place, bool begins_word);

/// Whether a character is of a script that has no blanks between words: Chinese, Japanese, Thai,
/// Lao, Burmese, Khmer, with their punctuation. Korean has blanks.
bool is_unspaced(char32_t c);

/// Sets TimedLabel::word and TimedLabel::link of phones to the word that is spoken in the middle of
/// each. `words` are ascending; those with empty text are pauses.
void attach_words(std::vector<TimedLabel>& phones, const std::vector<TimedLabel>& words);

}  // namespace animeme::dam
