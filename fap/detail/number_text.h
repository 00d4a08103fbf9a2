// Numbers as text and back, the same on every machine. Internal.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fap/detail/real_text.h"

namespace animeme::fap::detail {

/// With `digits` significant digits at most, without an exponent for usual sizes.
inline void append_significant(std::string& text, float number, int digits) {
  if (number == 0) number = 0;  // no -0
  append_digits(text, number, digits);
}

/// The whole of `token` as a finite number; a '+' may stand before it.
template <std::floating_point T = double>
std::optional<T> finite_number(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  T value = 0;
  const auto [end, code] = read_real(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || code != std::errc() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace animeme::fap::detail
