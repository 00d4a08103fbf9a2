// The grammar below session descriptions: words, numbers, bytes, parameter lists. Nothing here
// allocates more than its input is long.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/media/live/sdp.h"

namespace animeme::media {

/// Upper case.
std::string to_hex(std::span<const std::uint8_t> bytes);
/// Any case; nullopt: an odd number of digits or something else than digits.
std::optional<std::vector<std::uint8_t>> from_hex(std::string_view text);

std::string_view trim(std::string_view text);
std::string lower(std::string_view text);
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

/// One medium as it was read, before anybody asks whether it is for us. What was not said: an empty
/// address, rtcp_port 0, payload_type -1.
struct SdpMedium : RtpTrack {
  std::string kind;      // "video", "audio" ...
  std::string encoding;  // lower case; empty: no rtpmap
  std::uint32_t channels = 1;
  Parameters format;  // a=fmtp
  Parameters own;     // a=x-animeme
  std::string cname;
  int bundle_id = 0;
  std::int64_t line = 0;
};

}  // namespace animeme::media
