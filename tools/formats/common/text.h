/// @file
/// Text formatting: printf to a string, joining of lists.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

namespace animeme::tools {

/// Like std::printf(), to a string of any length.
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
  va_list values;
  va_start(values, pattern);
  va_list again;
  va_copy(again, values);
  std::string text(std::size_t(std::vsnprintf(nullptr, 0, pattern, values)) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), pattern, again);
  va_end(again);
  va_end(values);
  text.pop_back();  // the zero
  return text;
}

/// Joins the texts of a list.
inline std::string joined(const std::vector<std::string>& list, const char* between) {
  std::string text;
  for (const std::string& one : list) text += (text.empty() ? "" : between) + one;
  return text;
}

}  // namespace animeme::tools
