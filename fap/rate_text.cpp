#include "fap/rate_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace animeme::fap {
namespace {

constexpr int kMaxDecimals = 9;            // 2^32 * 10^9 * 2 still fits 64 bits
constexpr int kFewestRoundedDecimals = 7;  // from here on a decimal number means a nearby fraction
constexpr double kNameError = 0.001;       // of the decimal name of a rate
constexpr std::array<std::uint32_t, 6> kNtscBases = {15, 24, 30, 48, 60, 120};

struct Fraction {
  std::uint64_t num = 0;
  std::uint64_t den = 1;
};

struct Decimal {
  std::uint64_t digits = 0;  // the number times 10^decimals
  int decimals = 0;
};

std::uint64_t power_of_ten(int exponent) {
  std::uint64_t power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  return power;
}

Error not_a_rate(std::string_view text) {
  return make_error(Code::syntax, "'" + std::string(text.substr(0, 24)) +
                                      "' is not a frame rate, write for instance 25, 12.5, 29.97 "
                                      "or 30000/1001");
}

// Only digits: from_chars alone would also take a sign.
std::optional<std::uint64_t> parse_digits(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

Result<Rate> to_rate(Fraction f) {
  const std::uint64_t divisor = std::gcd(f.num, f.den);
  f.num /= divisor;
  f.den /= divisor;
  constexpr std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
  if (f.num > limit || f.den > limit) {
    return make_error(Code::out_of_range, "the frame rate is too large or has too many digits");
  }
  return Rate{std::uint32_t(f.num), std::uint32_t(f.den)};
}

// The fraction with the smallest denominator in [low, high], by continued fractions.
Fraction simplest_between(Fraction low, Fraction high) {
  const std::uint64_t whole = low.num / low.den;
  if (whole * low.den == low.num) return {whole, 1};
  if (whole < high.num / high.den) return {whole + 1, 1};
  const Fraction rest = simplest_between({high.den, high.num - whole * high.den},
                                         {low.den, low.num - whole * low.den});
  return {whole * rest.num + rest.den, rest.num};
}

// 1000 * base / 1001 rounded to `decimals` places, times 10^decimals.
std::uint64_t ntsc_digits(std::uint32_t base, int decimals) {
  const std::uint64_t scaled = std::uint64_t(base) * 1000 * power_of_ten(decimals);
  return (scaled * 2 + 1001) / 2002;
}

std::optional<Rate> ntsc_rate(const Decimal& d) {
  if (d.decimals < 2) return std::nullopt;
  for (const std::uint32_t base : kNtscBases) {
    // 14.99 is not a name that anybody gives to 15000/1001.
    if (base == 15 && d.decimals < 3) continue;
    if (ntsc_digits(base, d.decimals) == d.digits) return make_rate(base * 1000, 1001);
  }
  return std::nullopt;
}

Result<Rate> rate_of(const Decimal& d) {
  if (const std::optional<Rate> ntsc = ntsc_rate(d)) return *ntsc;
  const std::uint64_t scale = power_of_ten(d.decimals);
  if (d.decimals < kFewestRoundedDecimals || d.digits == 0) return to_rate({d.digits, scale});
  return to_rate(simplest_between({2 * d.digits - 1, 2 * scale}, {2 * d.digits + 1, 2 * scale}));
}

std::string to_text(const Decimal& d) {
  std::string digits = std::to_string(d.digits);
  if (d.decimals == 0) return digits;
  const std::size_t places = std::size_t(d.decimals);
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  digits.insert(digits.size() - places, 1, '.');
  return digits;
}

}  // namespace

Result<Rate> parse_rate(std::string_view text) {
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    const auto num = parse_digits(text.substr(0, slash));
    const auto den = parse_digits(text.substr(slash + 1));
    if (!num || !den || *den == 0) return not_a_rate(text);
    return to_rate({*num, *den});
  }
  const std::size_t point = text.find('.');
  const auto whole = parse_digits(text.substr(0, point));
  if (!whole) return not_a_rate(text);
  Decimal decimal{*whole, 0};
  if (point != std::string_view::npos) {
    const std::string_view places = text.substr(point + 1);
    const auto fraction = places.empty() ? std::optional<std::uint64_t>(0) : parse_digits(places);
    if (!fraction || places.size() > kMaxDecimals) return not_a_rate(text);
    decimal.decimals = int(places.size());
    if (*whole > std::numeric_limits<std::uint32_t>::max()) return to_rate({*whole, 1});
    decimal.digits = *whole * power_of_ten(decimal.decimals) + *fraction;
  }
  return rate_of(decimal);
}

std::string format_rate(Rate rate) {
  if (!rate.valid()) return "0";
  for (int decimals = 0; decimals <= kMaxDecimals; ++decimals) {
    const std::uint64_t scaled = std::uint64_t(rate.num) * power_of_ten(decimals);
    const Decimal nearest{scaled / rate.den + (scaled % rate.den * 2 >= rate.den ? 1u : 0u),
                          decimals};
    const Result<Rate> read = rate_of(nearest);
    // 23.98 means 24000/1001, but people write 23.976.
    const double error = double(nearest.digits) / double(power_of_ten(decimals)) -
                         double(rate.num) / double(rate.den);
    if (read && *read == rate && std::abs(error) < kNameError) return to_text(nearest);
  }
  return std::to_string(rate.num) + "/" + std::to_string(rate.den);
}

}  // namespace animeme::fap
