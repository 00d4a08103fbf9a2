/// @file
/// SHA-256 of a file's bytes. Source: FIPS 180-4.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace animeme::conformance {

/// 64 lower-case hexadecimal digits, as sha256sum prints them.
std::string sha256(std::span<const std::uint8_t> bytes);
/// Likewise, of a text.
inline std::string sha256(std::string_view text) {
  return sha256(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace animeme::conformance
