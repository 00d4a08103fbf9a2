// Little endian numbers and texts to bytes and back: the alphabet of our files.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::dam {

class ByteWriter {
 public:
  template <class Unsigned>
  void number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
      bytes.push_back(std::uint8_t((std::uint64_t(value) >> (8 * i)) & 0xFF));
  }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void single(float value) { number(std::bit_cast<std::uint32_t>(value)); }
  /// u32 length and UTF-8.
  void text(std::string_view value) {
    number(std::uint32_t(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
  }
  std::vector<std::uint8_t> bytes;
};

/// Reads numbers until the bytes run out; then failed() stays set and everything is 0.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Unsigned>
  Unsigned number() {
    if (!has(sizeof(Unsigned))) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
      value |= std::uint64_t(bytes_[at_ + i]) << (8 * i);
    at_ += sizeof(Unsigned);
    return Unsigned(value);
  }
  double real() { return std::bit_cast<double>(number<std::uint64_t>()); }
  float single() { return std::bit_cast<float>(number<std::uint32_t>()); }
  std::string text() {
    const std::size_t size = number<std::uint32_t>();
    if (!has(size)) return {};
    std::string value(size, '\0');
    if (size > 0) std::memcpy(value.data(), bytes_.data() + at_, size);
    at_ += size;
    return value;
  }
  /// A count of things of `smallest` bytes at least; fails if they cannot all be there, so that
  /// nothing is allocated that the input does not pay for.
  std::size_t count(std::size_t smallest) { return limited(number<std::uint32_t>(), smallest); }
  /// The same for a count that is known already.
  std::size_t limited(std::size_t count, std::size_t smallest) {
    if (count > (bytes_.size() - at_) / smallest) failed_ = true;
    return failed_ ? 0 : count;
  }
  bool failed() const { return failed_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  bool has(std::size_t size) {
    if (size > bytes_.size() - at_) failed_ = true;
    return !failed_;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace animeme::dam
