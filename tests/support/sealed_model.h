// Model files with a checksum that fits whatever they hold: wrong in other ways only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::test {

/// CRC-32 as in zip, bit by bit: not the code that it tests.
inline std::uint32_t plain_crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t c = 0xFFFFFFFFu;
  for (const std::uint8_t b : bytes) {
    c ^= b;
    for (int i = 0; i < 8; ++i) c = (c >> 1) ^ ((c & 1) != 0 ? 0xEDB88320u : 0u);
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
