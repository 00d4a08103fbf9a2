// A number that tells contents apart: FNV-1a, 64 bits, its bits well mixed at the end. Not a
// protection against people who mean harm. Internal.
#pragma once

#include <cstdint>
#include <span>

namespace animeme::dam {

inline std::uint64_t digest_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t h = 0xCBF29CE484222325u;
  for (const std::uint8_t b : bytes) h = (h ^ b) * 0x100000001B3u;
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return h ^ (h >> 33);
}

}  // namespace animeme::dam
