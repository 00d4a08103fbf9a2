// Reading and writing bits, most significant bit first. The reader never touches memory outside
// its span: past the end it returns zeros and remembers that it did (sticky), so that a whole
// header can be read and checked once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::fba {

/// Reads bits of a byte span. Copyable; positions are bits from the start of the span.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes, std::size_t bit = 0)
      : bytes_(bytes), bit_(bit) {}

  std::size_t position() const { return bit_; }
  std::size_t size() const { return bytes_.size() * 8; }
  /// True once a read went past the end; stays true.
  bool overrun() const { return bit_ > size(); }
  void seek(std::size_t bit) { bit_ = bit; }

  /// One bit; 0 past the end.
  std::uint32_t bit() {
    const std::size_t byte = bit_ >> 3;
    const std::uint32_t value =
        byte < bytes_.size() ? (std::uint32_t(bytes_[byte]) >> (7 - (bit_ & 7))) & 1U : 0U;
    ++bit_;
    return value;
  }

  /// `count` (0..32) bits as an unsigned number.
  std::uint32_t bits(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = (value << 1) | bit();
    return value;
  }

  /// 32 bits at an absolute position, without moving; zeros past the end.
  std::uint32_t peek32(std::size_t bit) const {
    BitReader copy(bytes_, bit);
    return copy.bits(32);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t bit_ = 0;
};

/// Appends bits to a byte vector.
class BitWriter {
 public:
  void bit(std::uint32_t value) {
    accumulator_ = (accumulator_ << 1) | (value & 1U);
    if (++pending_ == 8) {
      bytes_.push_back(std::uint8_t(accumulator_));
      accumulator_ = 0;
      pending_ = 0;
    }
  }
  /// The low `count` (0..32) bits of `value`.
  void bits(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bit(value >> i);
  }
  /// next_start_code() of the standard: a 0 and then 1s up to the byte border, a whole byte 7F if
  /// already aligned.
  void stuff() {
    bit(0);
    while (pending_ != 0) bit(1);
  }
  /// A 32-bit start code; call at a byte border.
  void start_code(std::uint32_t code) { bits(code, 32); }

  bool aligned() const { return pending_ == 0; }
  std::size_t position() const { return bytes_.size() * 8 + std::size_t(pending_); }
  /// The complete bytes so far.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  /// Hands the complete bytes over and keeps the bits of the unfinished one.
  std::vector<std::uint8_t> take() {
    std::vector<std::uint8_t> out;
    out.swap(bytes_);
    return out;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint32_t accumulator_ = 0;
  int pending_ = 0;
};

}  // namespace animeme::fba
