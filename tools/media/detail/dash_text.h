// Numbers, durations and name templates in DASH descriptions. Source: ISO/IEC 23009-1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace animeme::media {

inline constexpr std::size_t kLongestName = 2048;

/// All of `text` as a number; nullopt: it is none.
std::optional<std::int64_t> whole_number(const std::string& text);

/// "PT1H2M3.5S" in seconds; nullopt: another form, which is not used for clips.
std::optional<double> period_seconds(std::string_view text);

/// Fills in $Number$, $Number%05d$, $Time$, $RepresentationID$ and $$; nullopt: another name, or
/// the pattern is too long.
std::optional<std::string> fill_in(std::string_view pattern, std::int64_t number, std::int64_t time,
                                   const std::string& id);

}  // namespace animeme::media
