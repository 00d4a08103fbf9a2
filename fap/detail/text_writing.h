// What the writers of FAP and BAP text share. Internal.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

namespace animeme::fap::detail {

/// The name as the header can hold it: one word that is no comment, "clip" for an empty one.
inline std::string one_word(const std::string& name) {
  if (name.empty()) return "clip";
  std::string word = name;
  std::replace_if(
      word.begin(), word.end(), [](char c) { return (c >= 0 && c <= ' ') || c == '\x7f'; }, '_');
  if (word.front() == '#') word.front() = '_';
  return word;
}

inline void append_number(std::string& text, std::int64_t number) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

}  // namespace animeme::fap::detail
