/// @file
/// Bit reader and writer, most significant bit first. The reader never accesses memory outside its
/// span: past the end it returns zeros and sets a sticky flag, so that a whole header can be read
/// and checked once.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace animeme::fba {

/// Reads bits of a byte span. Copyable; positions count bits from the start of the span.
class BitReader {
 public:
  /// Starts at bit `bit`; the bytes are borrowed.
  explicit BitReader(std::span<const std::uint8_t> bytes, std::size_t bit = 0)
      : bytes_(bytes), bit_(bit) {}

  std::size_t position() const { return bit_; }                   ///< of the next bit
  std::size_t size() const { return bytes_.size() * 8; }          ///< in bits
  std::span<const std::uint8_t> bytes() const { return bytes_; }  ///< all of them, read or not
  /// True once a read went past the end; stays true.
  bool overrun() const { return bit_ > size(); }
  void seek(std::size_t bit) { bit_ = bit; }  ///< any position, also past the end

  /// Whether the bits from here to the byte boundary, or a whole byte at one, are those of
  /// BitWriter::stuff().
  bool at_stuffing() const {
    BitReader in = *this;
    const std::size_t boundary = (bit_ / 8 + 1) * 8;
    if (boundary > size() || in.bit() != 0) return false;
    while (in.bit_ < boundary) {
      if (in.bit() == 0) return false;
    }
    return true;
  }

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
    const std::uint64_t value = std::uint64_t(peek32()) >> (32 - count);
    bit_ += std::size_t(count);
    return std::uint32_t(value);
  }

  /// The next 32 bits without advancing; zeros past the end.
  std::uint32_t peek32() const { return peek32(bit_); }
  /// 32 bits at an absolute position; zeros past the end.
  std::uint32_t peek32(std::size_t bit) const {
    const std::size_t byte = bit >> 3;
    if (byte + 8 <= bytes_.size()) {
      std::uint64_t window = 0;
      std::memcpy(&window, &bytes_[byte], sizeof window);
      if constexpr (std::endian::native == std::endian::little) window = __builtin_bswap64(window);
      return std::uint32_t((window << (bit & 7)) >> 32);
    }
    return peek_at_end(bit);
  }

 private:
  std::uint32_t peek_at_end(std::size_t bit) const {
    std::uint64_t window = 0;
    for (std::size_t byte = bit >> 3; byte < (bit >> 3) + 8; ++byte) {
      window = window << 8 | (byte < bytes_.size() ? bytes_[byte] : 0U);
    }
    return std::uint32_t((window << (bit & 7)) >> 32);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t bit_ = 0;
};

/// Appends bits to a byte vector.
class BitWriter {
 public:
  void bit(std::uint32_t value) { bits(value & 1U, 1); }  ///< the lowest bit of `value`
  /// The low `count` (0..32) bits of `value`.
  void bits(std::uint32_t value, int count) {
    const std::uint64_t mask = (std::uint64_t(1) << count) - 1;
    accumulator_ = (accumulator_ << count) | (value & mask);
    pending_ += count;
    if (pending_ >= 32) write_word();
  }
  /// Removes the last `count` bits; they must belong to the unfinished byte.
  std::uint32_t take_back(int count) {
    const std::uint32_t value = std::uint32_t(accumulator_) & ((1U << count) - 1);
    accumulator_ >>= count;
    pending_ -= count;
    return value;
  }
  /// next_start_code() of the standard: a 0 and then 1s up to the byte boundary, a whole byte 7F if
  /// already aligned.
  void stuff() {
    const int count = 8 - pending_ % 8;
    bits((1U << (count - 1)) - 1, count);
  }
  /// A 32-bit start code; call at a byte boundary.
  void start_code(std::uint32_t code) { bits(code, 32); }

  bool aligned() const { return pending_ % 8 == 0; }  ///< at a byte boundary
  /// Bits written so far.
  std::size_t position() const { return used_ * 8 + std::size_t(pending_); }
  /// The complete bytes so far.
  const std::vector<std::uint8_t>& bytes() {
    write_bytes();
    bytes_.resize(used_);
    return bytes_;
  }
  /// Moves the complete bytes out and keeps the bits of the unfinished one.
  std::vector<std::uint8_t> take() {
    write_bytes();
    bytes_.resize(used_);
    std::vector<std::uint8_t> out;
    out.swap(bytes_);
    used_ = 0;
    return out;
  }
  /// The same as a copy: both vectors keep their memory for reuse.
  void take(std::vector<std::uint8_t>& out) {
    write_bytes();
    out.assign(bytes_.begin(), bytes_.begin() + std::ptrdiff_t(used_));
    used_ = 0;
  }

 private:
  // Moves 32 bits out of the accumulator.
  void write_word() {
    pending_ -= 32;
    std::uint32_t word = std::uint32_t(accumulator_ >> pending_);
    if constexpr (std::endian::native == std::endian::little) word = __builtin_bswap32(word);
    make_room();
    std::memcpy(&bytes_[used_], &word, sizeof word);
    used_ += sizeof word;
  }
  // Moves the complete bytes out of the accumulator.
  void write_bytes() {
    make_room();
    for (; pending_ >= 8; pending_ -= 8) {
      bytes_[used_++] = std::uint8_t(accumulator_ >> (pending_ - 8));
    }
  }
  // For four more bytes.
  void make_room() {
    constexpr std::size_t kLeast = 64;
    if (used_ + 4 > bytes_.size()) bytes_.resize(std::max(kLeast, 2 * bytes_.size()));
  }

  std::vector<std::uint8_t> bytes_;  // with room behind what is used
  std::size_t used_ = 0;             // bytes written
  std::uint64_t accumulator_ = 0;    // the low pending_ bits are still to be written
  int pending_ = 0;                  // 0..31 between calls
};

}  // namespace animeme::fba
