#include "tools/view/gltf/detail/words.h"

#include <algorithm>

namespace animeme::gltf {
namespace {

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_small(char c) { return (c >= 'a' && c <= 'z') || (c & 0x80) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// True if a word begins at `i`, which is not the first letter of the name.
bool starts_word(std::string_view name, std::size_t i) {
  const char before = name[i - 1];
  if (is_capital(name[i])) {
    const bool last_capital = i + 1 < name.size() && is_small(name[i + 1]) && is_capital(before);
    return is_small(before) || is_digit(before) || last_capital;
  }
  return is_digit(name[i]) && is_small(before);
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool inside = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool part = is_capital(c) || is_small(c) || is_digit(c);
    if (part && (!inside || starts_word(name, i))) words.emplace_back();
    if (part) words.back() += is_capital(c) ? char(c - 'A' + 'a') : c;
    inside = part;
  }
  for (std::string& word : words) {
    if (word == "l" || word == "lft") word = "left";
    if (word == "r" || word == "rgt") word = "right";
  }
  return words;
}

std::string joined(const std::vector<std::string>& words, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < words.size(); ++i) text += words[i];
  return text;
}

std::string list_of(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    text += (i == 0 ? "" : ", ") + names[i].substr(0, 60);
  }
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

bool has_word(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace animeme::gltf
