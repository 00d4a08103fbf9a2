// Bytes for the page: what bytes.js reads.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace animeme::viewer::detail {

/// Numbers one after the other, little-endian.
class Bytes {
 public:
  void u8(std::uint32_t value) { data_.push_back(std::uint8_t(value)); }
  void u16(std::uint32_t value);
  void u32(std::uint32_t value);
  /// Seven bits a byte, low ones first; the high bit says that more follow.
  void varint(std::uint64_t value);
  /// A signed number as a varint: 0, -1, 1, -2 ... are 0, 1, 2, 3.
  void zigzag(std::int64_t value);
  void text(const std::string& text) {
    for (const char c : text) u8(std::uint8_t(c));
  }
  void append(const Bytes& other);

  const std::vector<std::uint8_t>& data() const { return data_; }
  std::vector<std::uint8_t> take() { return std::move(data_); }

 private:
  std::vector<std::uint8_t> data_;
};

/// A length of 32 bits, a header in JSON, the rest.
Bytes with_header(const std::string& json, const Bytes& rest);

/// Smaller, as zlib writes it (RFC 1950); other versions of zlib may choose other bytes.
std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes);

std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace animeme::viewer::detail
