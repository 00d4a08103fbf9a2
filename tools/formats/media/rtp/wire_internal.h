// Numbers in network byte order, written and read without reaching outside the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::media {

using ByteVector = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// Appends the low `bytes` (1..8) bytes of `value`, highest first.
inline void put(ByteVector& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(std::uint8_t(value >> (8 * i)));
}

inline void append(ByteVector& out, ByteSpan bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// The number of `count` (up to 8) bytes at `at`, which must be there.
inline std::uint64_t read_big_endian(ByteSpan bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Puts the low `count` bytes of `value` at `at`, which must be there, highest first.
inline void write_big_endian(std::span<std::uint8_t> bytes, std::size_t at, std::size_t count,
                             std::uint64_t value) {
  for (; count > 0; value >>= 8) bytes[at + --count] = std::uint8_t(value);
}

/// Takes numbers off the front. Past the end it gives zeros and says so for good.
class WireReader {
 public:
  explicit WireReader(ByteSpan bytes) : bytes_(bytes) {}

  std::uint64_t get(int bytes) {
    const ByteSpan part = take(std::size_t(bytes));
    return read_big_endian(part, 0, part.size());
  }
  std::uint8_t u8() { return std::uint8_t(get(1)); }
  std::uint16_t u16() { return std::uint16_t(get(2)); }
  std::uint32_t u32() { return std::uint32_t(get(4)); }

  /// `count` bytes; none if there are not so many.
  ByteSpan take(std::size_t count) {
    if (count > bytes_.size()) {
      failed_ = true;
      bytes_ = {};
      return {};
    }
    const ByteSpan part = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return part;
  }
  ByteSpan rest() const { return bytes_; }
  std::size_t left() const { return bytes_.size(); }
  bool failed() const { return failed_; }

 private:
  ByteSpan bytes_;
  bool failed_ = false;
};

}  // namespace animeme::media
