// What the writers of FAP and BAP text share. Internal.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "fap/rate.h"

namespace animeme::fap::detail {

/// Longest name, in bytes: Xface has room for 254, and the exact rate comes behind it.
inline constexpr std::size_t kLongestName = 200;

/// The name as the header can hold it: one word that is no comment, "clip" for an empty one.
inline std::string one_word(const std::string& name) {
  if (name.empty()) return "clip";
  std::string word = name.substr(0, kLongestName);
  std::replace_if(
      word.begin(), word.end(),
      [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\x7f'; }, '_');
  if (word.front() == '#') word.front() = '_';
  return word;
}

/// The suffix of the name for a rate that the header has as a whole number only.
std::string exact_rate_tag(Rate rate);
/// Where the tag begins if `name` ends with one and the header has the rate `whole`; else npos.
std::size_t exact_rate_at(std::string_view name, Rate whole);
/// The rate of that tag.
Rate exact_rate_of(std::string_view tag);

inline void append_number(std::string& text, std::int64_t number) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

}  // namespace animeme::fap::detail
