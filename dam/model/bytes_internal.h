// Little endian numbers and texts to bytes and back: the alphabet of our files. The libc++ of
// Emscripten 3.1 lacks std::bit_cast, its compiler has what is behind it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace animeme::dam {

class ByteWriter {
 public:
  /// Whole numbers and enumerations, float, double, texts (u32 length and UTF-8); of a list its
  /// elements, without their number.
  template <class... Values>
  void put(const Values&... values) {
    (put_one(values), ...);
  }
  /// How many of something follow.
  void count(std::size_t value) { put(std::uint32_t(value)); }
  std::vector<std::uint8_t> bytes;

 private:
  template <class Value>
  void put_one(const Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      put(__builtin_bit_cast(std::uint64_t, value));
    } else if constexpr (std::is_same_v<Value, float>) {
      put(__builtin_bit_cast(std::uint32_t, value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      count(value.size());
      bytes.insert(bytes.end(), value.begin(), value.end());
    } else if constexpr (requires { value.begin(); }) {
      for (const auto& element : value) put(element);
    } else {
      for (std::size_t i = 0; i < sizeof(Value); ++i)
        bytes.push_back(std::uint8_t((std::uint64_t(value) >> (8 * i)) & 0xFF));
    }
  }
};

/// Reads numbers until the bytes run out; then failed() stays set and everything is 0.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// What ByteWriter::put() writes; a list is filled as long as it is.
  template <class... Values>
  void get(Values&... values) {
    (get_one(values), ...);
  }
  template <class Value>
  Value next() {
    Value value{};
    get(value);
    return value;
  }
  /// A count of things of `smallest` bytes at least; fails if they cannot all be there, so that
  /// nothing is allocated that the input does not pay for.
  std::size_t count(std::size_t smallest) { return limited(next<std::uint32_t>(), smallest); }
  /// The same for a count that is known already.
  std::size_t limited(std::size_t count, std::size_t smallest) {
    if (count > (bytes_.size() - at_) / smallest) failed_ = true;
    return failed_ ? 0 : count;
  }
  bool failed() const { return failed_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  template <class Value>
  void get_one(Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      value = __builtin_bit_cast(double, next<std::uint64_t>());
    } else if constexpr (std::is_same_v<Value, float>) {
      value = __builtin_bit_cast(float, next<std::uint32_t>());
    } else if constexpr (std::is_same_v<Value, std::string>) {
      const std::size_t size = next<std::uint32_t>();
      value.clear();
      if (!has(size)) return;
      const auto begin = bytes_.begin() + std::ptrdiff_t(at_);
      value.assign(begin, begin + std::ptrdiff_t(size));
      at_ += size;
    } else if constexpr (requires { value.begin(); }) {
      for (auto& element : value) get(element);
    } else {
      std::uint64_t bits = 0;
      if (has(sizeof(Value))) {
        if constexpr (std::endian::native == std::endian::little) {
          std::memcpy(&bits, bytes_.data() + at_, sizeof(Value));
        } else {
          for (std::size_t i = 0; i < sizeof(Value); ++i)
            bits |= std::uint64_t(bytes_[at_ + i]) << (8 * i);
        }
        at_ += sizeof(Value);
      }
      value = Value(bits);
    }
  }
  bool has(std::size_t size) {
    if (size > bytes_.size() - at_) failed_ = true;
    return !failed_;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace animeme::dam
