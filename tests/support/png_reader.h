// Reads PNG files by the rules of the format, independent of our writer.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace animeme::test {

inline std::uint32_t big_endian(const Bytes& data, std::size_t at) {
  return std::uint32_t(data[at]) << 24 | std::uint32_t(data[at + 1]) << 16 |
         std::uint32_t(data[at + 2]) << 8 | data[at + 3];
}

/// The RGB bytes of a PNG of 8 bits RGB; empty if anything is wrong.
inline Bytes decode_png(const Bytes& png, int& width, int& height) {
  static constexpr std::uint8_t kStart[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (png.size() < 8 || std::memcmp(png.data(), kStart, 8) != 0) return {};
  Bytes packed;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = big_endian(png, at);
    if (at + 12 + size > png.size()) return {};
    const std::string type(png.begin() + std::ptrdiff_t(at + 4),
                           png.begin() + std::ptrdiff_t(at + 8));
    if (crc32(0, &png[at + 4], uInt(size + 4)) != big_endian(png, at + 8 + size)) return {};
    if (type == "IHDR") {
      width = int(big_endian(png, at + 8));
      height = int(big_endian(png, at + 12));
      if (png[at + 16] != 8 || png[at + 17] != 2) return {};
    }
    if (type == "IDAT") packed.insert(packed.end(), &png[at + 8], &png[at + 8] + size);
    at += 12 + size;
  }
  const std::size_t line = std::size_t(width) * 3;
  Bytes rows((line + 1) * std::size_t(height));
  uLongf size = uLongf(rows.size());
  if (uncompress(rows.data(), &size, packed.data(), uLong(packed.size())) != Z_OK) return {};
  Bytes out(line * std::size_t(height));
  for (std::size_t y = 0; y < std::size_t(height); ++y) {
    for (std::size_t x = 0; x < line; ++x) {
      const int a = x >= 3 ? out[y * line + x - 3] : 0;
      const int b = y > 0 ? out[(y - 1) * line + x] : 0;
      const int c = x >= 3 && y > 0 ? out[(y - 1) * line + x - 3] : 0;
      const int p = a + b - c;
      const int nearest = std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c)
                              ? a
                          : std::abs(p - b) <= std::abs(p - c) ? b
                                                               : c;
      const int guesses[] = {0, a, b, (a + b) / 2, nearest};
      const std::uint8_t filter = rows[y * (line + 1)];
      if (filter > 4) return {};
      out[y * line + x] = std::uint8_t(rows[y * (line + 1) + 1 + x] + guesses[filter]);
    }
  }
  return out;
}

}  // namespace animeme::test
