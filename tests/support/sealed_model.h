// Model files with a checksum that fits whatever they hold: wrong in other ways only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::test {

/// CRC-32 as in zip, half a byte at a time: not the code that it tests.
inline std::uint32_t plain_crc32(std::span<const std::uint8_t> bytes) {
  static const auto steps = [] {
    std::array<std::uint32_t, 16> out{};
    for (std::uint32_t n = 0; n < 16; ++n) {
      out[n] = n;
      for (int i = 0; i < 4; ++i) out[n] = (out[n] >> 1) ^ ((out[n] & 1) != 0 ? 0xEDB88320u : 0u);
    }
    return out;
  }();
  std::uint32_t c = 0xFFFFFFFFu;
  for (const std::uint8_t b : bytes) {
    c = (c >> 4) ^ steps[(c ^ b) & 15];
    c = (c >> 4) ^ steps[(c ^ (b >> 4)) & 15];
  }
  return ~c;
}

/// Replaces the last four bytes (of at least four) by the checksum of those before.
inline void seal(std::vector<std::uint8_t>& bytes) {
  const std::size_t end = bytes.size() - 4;
  const std::uint32_t c = plain_crc32(std::span(bytes).first(end));
  for (std::size_t i = 0; i < 4; ++i) bytes[end + i] = std::uint8_t(c >> (8 * i));
}

/// The same with the size of the body (u64 at byte 12) made right, too.
inline void seal_with_size(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 20, kChecksum = 4;
  if (bytes.size() < kHeader + kChecksum) return;
  const std::uint64_t size = bytes.size() - kHeader - kChecksum;
  for (std::size_t i = 0; i < 8; ++i) bytes[12 + i] = std::uint8_t(size >> (8 * i));
  seal(bytes);
}

}  // namespace animeme::test
