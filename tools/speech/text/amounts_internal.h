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

/// What stands at `at`, where no letter or digit is before. `end` is 0 if nothing is to be changed.
Amount amount_at(std::u32string_view text, std::size_t at, const std::string& language,
                 bool spell_digits);

}  // namespace animeme::text
