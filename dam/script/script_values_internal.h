// Times and labels in the text and the messages of scripts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::dam {

/// A time in seconds. Errors: syntax (no number), out_of_range (not finite, too large).
Result<double> parse_seconds(std::string_view field, std::int64_t line, std::string_view what,
                             std::int64_t column = 0);

/// `text` in quotes, fit to be shown: cut to 40 bytes, control characters replaced.
std::string in_quotes(std::string_view text);

/// Shortest text that reads back as the same number.
std::string format_seconds(double seconds);

}  // namespace animeme::dam
