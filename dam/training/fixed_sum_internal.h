// Sums that are the same in any order and of any parts: whole numbers of a small unit. Internal.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace animeme::dam {

/// A sum in 128 bits, in units of 2^-48: sums of 2^29 numbers up to kMost are exact, whatever
/// their order, so that parts add up to the bits of the whole. What is added is rounded once.
class FixedSum {
 public:
  static constexpr double kMost = 0x1p50;

  void add(double x) { add_raw(Unsigned(Signed(std::rint(x * kUnits)))); }  ///< |x| <= kMost
  void add(const FixedSum& other) { add_raw(other.raw()); }
  double value() const { return double(Signed(raw())) / kUnits; }

  /// As in a file: its two halves, the lower first.
  auto begin() { return words_.begin(); }
  auto begin() const { return words_.begin(); }
  auto end() { return words_.end(); }
  auto end() const { return words_.end(); }

 private:
  static constexpr double kUnits = 0x1p48;
  __extension__ typedef __int128 Signed;
  __extension__ typedef unsigned __int128 Unsigned;

  Unsigned raw() const { return Unsigned(words_[1]) << 64 | words_[0]; }
  // Wraps around in place of undefined behaviour: files may hold anything.
  void add_raw(Unsigned x) {
    const Unsigned sum = raw() + x;
    words_ = {std::uint64_t(sum), std::uint64_t(sum >> 64)};
  }

  std::array<std::uint64_t, 2> words_{};
};

/// The same in 64 bits, for matrices: units of 2^-30, up to kMost.
class SmallFixedSum {
 public:
  static constexpr double kMost = 0x1p32;

  void add(double x) { bits_ += std::uint64_t(std::int64_t(std::rint(x * kUnits))); }
  void add(SmallFixedSum other) { bits_ += other.bits_; }
  double value() const { return double(std::int64_t(bits_)) / kUnits; }

  std::uint64_t bits() const { return bits_; }
  void set_bits(std::uint64_t bits) { bits_ = bits; }

  friend bool operator==(SmallFixedSum, SmallFixedSum) = default;

 private:
  static constexpr double kUnits = 0x1p30;
  std::uint64_t bits_ = 0;
};

}  // namespace animeme::dam
