// std::from_chars and std::to_chars for numbers with a fraction, which not every C++ library has
// (libc++ before LLVM 20). Internal.
#pragma once

#include <charconv>
#include <string>
#include <version>

namespace animeme::fap::detail {

/// What these functions of the C++ library do, by the C library: the same to the last bit and byte,
/// slower, whatever the locale. Only used where they are missing.
std::from_chars_result read_by_c_library(const char* first, const char* last, float& value);
std::from_chars_result read_by_c_library(const char* first, const char* last, double& value);
std::string shortest_by_c_library(float value);
std::string shortest_by_c_library(double value);
std::string digits_by_c_library(double value, int digits);

/// std::from_chars(first, last, value).
template <typename T>
std::from_chars_result read_real(const char* first, const char* last, T& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  return read_by_c_library(first, last, value);
#endif
}

/// The shortest text that reads back as the same number.
template <typename T>
void append_shortest(std::string& text, T value) {
#ifdef __cpp_lib_to_chars
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
#else
  text += shortest_by_c_library(value);
#endif
}

/// As "%g" with so many digits.
inline void append_digits(std::string& text, float value, int digits) {
#ifdef __cpp_lib_to_chars
  char buffer[48];
  constexpr auto form = std::chars_format::general;
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value, form, digits).ptr);
#else
  text += digits_by_c_library(value, digits);
#endif
}

}  // namespace animeme::fap::detail
