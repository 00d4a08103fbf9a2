// Bytes for the page: what bytes.js reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/json.h"

namespace animeme::viewer::detail {

/// Numbers one after the other, little-endian.
class Bytes {
 public:
  void u8(std::uint32_t value) { data_.push_back(std::uint8_t(value)); }
  void u16(std::uint32_t value);
  /// Seven bits a byte, low ones first; the high bit says that more follow.
  void varint(std::uint64_t value);
  /// A signed number as a varint: 0, -1, 1, -2 ... are 0, 1, 2, 3.
  void zigzag(std::int64_t value);

  const std::vector<std::uint8_t>& data() const { return data_; }

 private:
  std::vector<std::uint8_t> data_;
};

/// In a line, ASCII alone; bytes that are no UTF-8 become U+FFFD.
std::string text_of(const tools::Json& json);

/// A length of 32 bits, a header in JSON, the rest.
std::vector<std::uint8_t> with_header(const tools::Json& header, const Bytes& rest);

/// Smaller, as zlib writes it (RFC 1950); other versions of zlib may choose other bytes.
std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes);

std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace animeme::viewer::detail
