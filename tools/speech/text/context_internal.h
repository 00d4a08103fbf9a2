// What stands around a place of a text: for what is read by its neighbours. Inside of written.cpp.
// No function looks at more than a few words, so that a text is read in a time that is linear in
// its length.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace animeme::text {

/// "de" of "de-at", "en" of "en-us+f3".
std::string language_base(std::string_view language);

/// A blank inside a line.
bool is_space(char32_t c);

/// A letter in upper case.
bool is_upper(char32_t c);

/// Behind blanks of the same line; not more than `most` of them.
std::size_t spaces_end(std::u32string_view text, std::size_t at, std::size_t most = 2);

/// The word, of letters, marks and apostrophes, that ends at `end` or before blanks there; its
/// place is [first, last). Empty if something else is between, or at a longer word than people
/// write.
struct WordPlace {
  std::size_t first = 0, last = 0;  ///< code points
  bool empty() const { return last <= first; }
};
WordPlace word_before(std::u32string_view text, std::size_t end);
/// The word that begins at `at` or behind blanks there.
WordPlace word_behind(std::u32string_view text, std::size_t at);

/// In lower case, as UTF-8.
std::string lower_word(std::u32string_view text, WordPlace word);

/// Whether a list of words between blanks has a word.
bool has_word(std::string_view list, std::string_view word);

/// Behind `at` are only blanks and closing signs up to the end of the text or of a paragraph.
bool ends_text(std::u32string_view text, std::size_t at);

/// Behind `at` the next word is one in upper case; `starter`: one that often begins a sentence, and
/// is never a name ("He", "Der", "Il").
bool upper_follows(std::u32string_view text, std::size_t at);
bool starter_follows(std::u32string_view text, std::size_t at, std::string_view base);

}  // namespace animeme::text
