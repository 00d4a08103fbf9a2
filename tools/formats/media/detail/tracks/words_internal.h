// Words, numbers and bytes in texts: what file names, addresses, playlists and session descriptions
// are read with. Nothing here allocates more than its input is long.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/detail/text_scanner.h"

namespace animeme::media {

using fap::detail::lower_case;

/// Upper case.
std::string to_hex(std::span<const std::uint8_t> bytes);
/// Any case; nullopt: an odd number of digits or something else than digits.
std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text);

std::string_view trim(std::string_view text);
/// What stands in front of the first `mark`, trimmed; `text` goes on behind it.
std::string_view take_until(std::string_view& text, char mark);
/// Decimal digits alone, at most `highest`.
std::optional<std::uint32_t> to_number(std::string_view text, std::uint32_t highest);

/// "key=value; key=value", keys in lower case; the first of equal keys counts.
using Parameters = std::map<std::string, std::string, std::less<>>;
Parameters read_parameters(std::string_view text);
/// nullopt: not there or no number up to `highest`.
std::optional<std::uint32_t> number_of(const Parameters& parameters, std::string_view key,
                                       std::uint32_t highest);

}  // namespace animeme::media
