#include "dam/script/script_values_internal.h"

#include <cmath>

#include "fap/detail/real_text.h"

namespace animeme::dam {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, kShown)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7F ? '?' : c;
  }
  return out + (text.size() > kShown ? "...\"" : "\"");
}

std::string format_seconds(double seconds) {
  std::string text;
  fap::detail::append_shortest(text, seconds);
  return text;
}

Result<double> parse_seconds(std::string_view field, std::int64_t line, std::string_view what,
                             std::int64_t column) {
  std::string_view digits = field;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] =
      fap::detail::read_real(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value))) {
    return error_at_line(Code::out_of_range,
                         "the " + std::string(what) + " time " + in_quotes(field) +
                             " is not a finite number of seconds",
                         line, column);
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    std::string message = "the " + std::string(what) + " time " + in_quotes(field) +
                          " is not a number; write seconds with a decimal point, like 0.25";
    return error_at_line(Code::syntax, message, line, column);
  }
  return value == 0 ? 0.0 : value;  // no negative zero
}

}  // namespace animeme::dam
