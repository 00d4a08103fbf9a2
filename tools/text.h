/// @file
/// Sentences and tables as text: printf into a string.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace animeme::tools {

/// As std::printf(), of any length.
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

}  // namespace animeme::tools
