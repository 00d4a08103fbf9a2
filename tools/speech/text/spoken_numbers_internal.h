// Ways to say a number: for the readings of transcripts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// The words of a language that stand between numbers; empty where they are not known here.
struct NumberWords {
  std::string_view base;
  std::string_view point;    ///< of decimals
  std::string_view joins;    ///< "and" in 5 dollars and 50 cents
  std::string_view cents;    ///< the hundredth part of a dollar or euro
  std::string_view to;       ///< of a range
  std::string_view over;     ///< of a fraction
  std::string_view of;       ///< "three of four"; between day and month where it is said
  std::string_view percent;  ///< %
  std::string_view ampersand, plus, minus, number;
};
/// Those of a language; an entry of empty words for others.
const NumberWords& number_words(std::string_view base);

/// How a whole number is written and what it counts.
enum class Figures : std::uint8_t {
  grouped,  ///< with separators, or in a row of other words
  amount,   ///< of money or a unit: neither a year nor said digit by digit
  plain,    ///< digits alone
};

/// Says numbers of one language. The language must outlive it.
class SpokenNumbers {
 public:
  explicit SpokenNumbers(const std::string& language);

  const std::string& base() const { return base_; }
  const NumberWords& words() const { return *words_; }
  /// The decimal point.
  char point() const { return point_; }
  /// Whether dates are written with the month first.
  bool month_first() const { return month_first_; }

  /// "four", without signs where a word may be parted.
  std::string cardinal(long long value) const;
  /// "fourth"; empty where the language has no ordinals here.
  std::string ordinal(long long value, bool feminine = false) const;
  /// Each digit: "one nine eight four". `oh`: as English says zero in telephone numbers.
  std::string digit_by_digit(std::string_view digits, bool oh = false) const;
  /// The ways to say a year, the likeliest first.
  std::vector<std::string> years(int year) const;
  /// The ways to say a whole number of ASCII digits, the likeliest first.
  std::vector<std::string> whole(std::string_view digits, Figures figures) const;
  /// The ways to say "12.50", with the decimals as ASCII digits.
  std::vector<std::string> decimal(std::string_view whole, std::string_view decimals) const;
  /// "May"; empty if unknown.
  std::string month(int month) const;

 private:
  const std::string& language_;
  std::string base_;
  const NumberWords* words_;
  char point_;
  bool month_first_;
};

}  // namespace animeme::text
