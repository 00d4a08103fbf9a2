// C++ text as words and signs, and the brackets among them.
#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

namespace animeme::test {

using Tokens = std::vector<std::string_view>;

bool is_word(std::string_view token);
bool is_one_of(std::string_view token, std::initializer_list<std::string_view> words);

/// Words, numbers, "::", "->", a quotation mark for a string or a character, and single signs.
/// Comments and lines of the preprocessor are left out: both branches of a condition count. The
/// tokens are parts of `text`.
Tokens tokens_of(std::string_view text);

/// The place behind the bracket that closes the one at `open`; tokens.size() if none does.
std::size_t behind_bracket(const Tokens& tokens, std::size_t open);

/// The place behind the template list that begins at `open`, or `open` itself where '<' is the
/// operator.
std::size_t behind_list(const Tokens& tokens, std::size_t open);

}  // namespace animeme::test
