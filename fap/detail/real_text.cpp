#include "fap/detail/real_text.h"

#include <cctype>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace animeme::fap::detail {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// How many characters of `text` are `word`, in small letters or large: all or none.
std::size_t length_of_word(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return 0;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if ((text[i] | 0x20) != word[i]) return 0;
  }
  return word.size();
}

std::size_t length_of_digits(std::string_view text) {
  std::size_t n = 0;
  while (n < text.size() && is_digit(text[n])) ++n;
  return n;
}

// "inf", "infinity", "nan", "nan(7)".
std::size_t length_of_named(std::string_view text) {
  if (const std::size_t n = length_of_word(text, "infinity")) return n;
  if (const std::size_t n = length_of_word(text, "inf")) return n;
  std::size_t n = length_of_word(text, "nan");
  if (n == 0 || n == text.size() || text[n] != '(') return n;
  std::size_t end = n + 1;
  while (end < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
    ++end;
  return end < text.size() && text[end] == ')' ? end + 1 : n;
}

// The number that `text` begins with, as std::chars_format::general has it: no blank, no '+', no
// "0x", which strtod() would take.
std::size_t length_of_number(std::string_view text) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  text.remove_prefix(sign);
  if (const std::size_t n = length_of_named(text)) return sign + n;
  std::size_t n = length_of_digits(text), digits = n;
  if (n < text.size() && text[n] == '.') {
    const std::size_t behind = length_of_digits(text.substr(n + 1));
    digits += behind;
    n += 1 + behind;
  }
  if (digits == 0) return 0;
  if (n < text.size() && (text[n] | 0x20) == 'e') {
    std::size_t exponent = n + 1;
    if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
    const std::size_t count = length_of_digits(text.substr(exponent));
    if (count > 0) n = exponent + count;
  }
  return sign + n;
}

float to_real(const char* text, float) { return std::strtof(text, nullptr); }
double to_real(const char* text, double) { return std::strtod(text, nullptr); }

template <typename T>
std::from_chars_result parse_real(const char* first, const char* last, T& value) {
  std::string text(first, last);
  text.resize(length_of_number(text));
  if (text.empty()) return {first, std::errc::invalid_argument};
  const char* end = first + text.size();
  const std::size_t mantissa = text.find_first_of("eE");
  const bool zero = text.find_first_of("123456789inIN") >= mantissa;
  const bool named = text.find_first_of("nN") != text.npos;
  // The only thing that a locale changes.
  if (const std::size_t point = text.find('.'); point != text.npos) {
    text.replace(point, 1, std::localeconv()->decimal_point);
  }
  const T number = to_real(text.c_str(), T());
  if (!named && (std::isinf(number) || (number == 0 && !zero))) {
    return {end, std::errc::result_out_of_range};
  }
  value = number;
  return {end, std::errc()};
}

// printf() of one number, with a point.
std::string printed(const char* form, int precision, double value) {
  char buffer[400];
  const int length = std::snprintf(buffer, sizeof buffer, form, precision, value);
  std::string text(buffer, std::size_t(length));
  const std::string_view point = std::localeconv()->decimal_point;
  if (const std::size_t at = text.find(point); at != text.npos) text.replace(at, point.size(), ".");
  return text;
}

template <typename T>
bool reads_back(const std::string& text, T value) {
  T back = 0;
  return parse_real(text.data(), text.data() + text.size(), back).ec == std::errc() &&
         back == value;
}

// The fewest digits that read back as `value`, which is above 0, in the form "1.25e-07". Beside a
// power of two the numbers lie closer on one side, and the one that does may be the neighbour of
// the nearest.
template <typename T>
std::string fewest_digits(T value) {
  for (int digits = 1; digits < std::numeric_limits<T>::max_digits10; ++digits) {
    std::string text = printed("%.*e", digits - 1, value);
    if (reads_back(text, value)) return text;
    char& last = text[text.find('e') - 1];
    if (last == '9') continue;
    ++last;
    if (reads_back(text, value)) return text;
  }
  return printed("%.*e", std::numeric_limits<T>::max_digits10 - 1, value);
}

template <typename T>
std::string shortest(T value) {
  const std::string sign = std::signbit(value) ? "-" : "";
  if (std::isnan(value)) return sign + "nan";
  if (std::isinf(value)) return sign + "inf";
  if (value == 0) return sign + "0";
  value = std::abs(value);
  const std::string scientific = fewest_digits(value);
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  std::string digits = scientific.substr(0, 1);
  if (e > 2) digits += scientific.substr(2, e - 2);
  const int count = int(digits.size());
  std::string fixed;
  if (exponent >= count - 1) {
    fixed = printed("%.*f", 0, value);
  } else if (exponent >= 0) {
    fixed = digits.insert(std::size_t(exponent) + 1, ".");
  } else {
    fixed = "0." + std::string(std::size_t(-exponent - 1), '0') + digits;
  }
  return sign + (fixed.size() <= scientific.size() ? fixed : scientific);
}

}  // namespace

std::from_chars_result read_by_c_library(const char* first, const char* last, float& value) {
  return parse_real(first, last, value);
}

std::from_chars_result read_by_c_library(const char* first, const char* last, double& value) {
  return parse_real(first, last, value);
}

std::string shortest_by_c_library(float value) { return shortest(value); }

std::string shortest_by_c_library(double value) { return shortest(value); }

std::string digits_by_c_library(double value, int digits) { return printed("%.*g", digits, value); }

}  // namespace animeme::fap::detail
