// A PNG of RGBA pixels for tests, not compressed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tests/support/files.h"

namespace animeme::test {

namespace png {

inline void put(Bytes& out, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(word >> shift));
}

inline std::uint32_t crc(const Bytes& bytes) {
  std::uint32_t sum = ~0u;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int i = 0; i < 8; ++i) sum = sum >> 1 ^ (sum & 1 ? 0xEDB88320u : 0u);
  }
  return ~sum;
}

inline void chunk(Bytes& file, std::string_view type, const Bytes& data) {
  put(file, std::uint32_t(data.size()));
  Bytes body(type.begin(), type.end());
  body.insert(body.end(), data.begin(), data.end());
  file.insert(file.end(), body.begin(), body.end());
  put(file, crc(body));
}

}  // namespace png

/// `rgba`: rows from the top.
inline std::vector<std::uint8_t> png_of(const std::vector<std::uint8_t>& rgba, int width) {
  const std::size_t row = std::size_t(width) * 4;
  Bytes rows;
  for (std::size_t at = 0; at < rgba.size(); at += row) {
    rows.push_back(0);
    rows.insert(rows.end(), rgba.begin() + std::ptrdiff_t(at),
                rgba.begin() + std::ptrdiff_t(at + row));
  }
  Bytes data = {0x78, 0x01};
  constexpr std::size_t kBlock = 65535;  // as they are
  for (std::size_t at = 0; at < rows.size(); at += kBlock) {
    const auto size = std::uint16_t(std::min(kBlock, rows.size() - at));
    data.push_back(at + kBlock >= rows.size() ? 1 : 0);
    for (const std::uint16_t word : {size, std::uint16_t(~size)}) {
      data.push_back(std::uint8_t(word));
      data.push_back(std::uint8_t(word >> 8));
    }
    data.insert(data.end(), rows.begin() + std::ptrdiff_t(at),
                rows.begin() + std::ptrdiff_t(at + size));
  }
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : rows) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  png::put(data, b << 16 | a);
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  Bytes header;
  png::put(header, std::uint32_t(width));
  png::put(header, std::uint32_t(rgba.size() / row));
  header.insert(header.end(), {8, 6, 0, 0, 0});
  png::chunk(file, "IHDR", header);
  png::chunk(file, "IDAT", data);
  png::chunk(file, "IEND", {});
  return file;
}

}  // namespace animeme::test
