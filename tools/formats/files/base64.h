/// @file
/// Base64.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::tools {

/// Decodes base64 (RFC 4648) in the standard or the URL alphabet, with or without "=" padding.
/// nullopt: an invalid character.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text);

/// Encodes base64 (RFC 4648) in the standard alphabet, with "=" padding.
std::string base64_of(std::span<const std::uint8_t> bytes);

}  // namespace animeme::tools
