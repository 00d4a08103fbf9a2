/// @file
/// Bytes as text, and back.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::tools {

/// The bytes of base64 (RFC 4648), in the alphabet of files or of URLs, with or without "=" at its
/// end. Nothing: another character.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text);

/// As base64 (RFC 4648) in the alphabet of files, with "=" at its end.
std::string base64_of(std::span<const std::uint8_t> bytes);

}  // namespace animeme::tools
