// Dates, amounts and telephone numbers. Inside of written.cpp.
#pragma once

#include <string>
#include <string_view>

namespace animeme::text {

/// What is said instead of the characters up to `end`.
struct Amount {
  std::size_t end = 0;
  std::u32string words;
};

/// Reads the dates, amounts and telephone numbers of a text, in a time that is linear in its
/// length. The text and the language must outlive it.
class AmountReader {
 public:
  AmountReader(std::u32string_view text, const std::string& language, bool spell_digits)
      : text_(text), language_(language), spell_digits_(spell_digits) {}

  /// What stands at `at`, where no letter or digit is before. `end` is 0 if nothing is to be
  /// changed.
  Amount read(std::size_t at);

 private:
  std::u32string_view text_;
  const std::string& language_;
  bool spell_digits_;
  bool known_ = false;            // the next ones take a while, and most texts have no amount
  char32_t point_ = U'.';         // of decimals
  bool groups_by_blank_ = false;  // thousands
  std::string order_;             // of dates
};

}  // namespace animeme::text
