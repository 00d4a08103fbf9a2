// Numbers as text and back, the same on every machine. Internal.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace animeme::fap::detail {

/// The shortest text that reads back as the same number.
inline void append_shortest(std::string& text, float number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

/// With `digits` significant digits at most, without an exponent for usual sizes.
inline void append_significant(std::string& text, float number, int digits) {
  char buffer[48];
  if (number == 0) number = 0;  // no -0
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number,
                                    std::chars_format::general, digits)
                          .ptr);
}

/// The whole of `token` as a finite number; a '+' may stand before it.
template <std::floating_point T = double>
std::optional<T> finite_number(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  T value = 0;
  const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || code != std::errc() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace animeme::fap::detail
