/// @file
/// Numbers as bytes: what js/bytes.js and unpack.cpp read.
#pragma once

#include <cstdint>
#include <vector>

namespace animeme::viewer::detail {

/// Numbers one after the other, little-endian.
class Bytes {
 public:
  void u8(std::uint32_t value) { data_.push_back(std::uint8_t(value)); }
  void u16(std::uint32_t value) {
    u8(value & 0xFF);
    u8(value >> 8 & 0xFF);
  }
  void u32(std::uint32_t value) {
    u16(value & 0xFFFF);
    u16(value >> 16);
  }
  /// Seven bits a byte, low ones first; the high bit says that more follow.
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) u8(std::uint32_t(value & 0x7F) | 0x80);
    u8(std::uint32_t(value));
  }
  /// A signed number as a varint: 0, -1, 1, -2 ... are 0, 1, 2, 3.
  void zigzag(std::int64_t value) {
    varint(value < 0 ? ~(std::uint64_t(value) << 1) : std::uint64_t(value) << 1);
  }
  void append(const std::vector<std::uint8_t>& bytes) {
    data_.insert(data_.end(), bytes.begin(), bytes.end());
  }

  const std::vector<std::uint8_t>& data() const { return data_; }

 private:
  std::vector<std::uint8_t> data_;
};

}  // namespace animeme::viewer::detail
