// How many bits the adaptive coder takes for a row of levels, without coding it. Not installed API.
//
// An adaptive model that starts flat with n symbols gives the k-th of them, seen c times among t,
// the probability (c + 1) / (t + n). The product over a whole row does not depend on the order:
// its code length is log2((n-1+T)! / (n-1)!) - sum of log2(c!) over the symbols. (Totals above
// 16383, where the coder halves its counts, are left out of account.)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::fba::internal {

/// Code lengths in 1/65536 bit: integers, so that decisions are the same on every machine.
using Bits = std::int64_t;
inline constexpr Bits kOneBit = 65536;

Bits log2_of(std::uint32_t n);         ///< n >= 1
Bits log2_factorial(std::uint32_t n);  ///< log2(n!)

/// The 5-bit range numbers of one parameter between two intra planes, by RangeKind.
using RangeNumbers = std::array<std::uint8_t, 4>;

/// Levels between two intra planes: the intra level first, then differences are coded.
/// What they need and what they cost.
struct RunCost {
  RangeNumbers range{};
  bool fits = true;  // all levels and differences lie within +-1860
  Bits bits = 0;     // range numbers, intra symbol and predictive symbols
};

/// `levels` are those of the reconstruction, plane by plane.
RunCost run_cost(std::span<const std::int32_t> levels, int scale);
/// The ranges alone.
RunCost run_ranges(std::span<const std::int32_t> levels, int scale);

/// How often each difference occurs.
class Histogram {
 public:
  /// Counts the differences of neighbours that lie in `low` to `high`.
  void count(std::span<const std::int32_t> levels, std::int32_t low, std::int32_t high);
  std::uint32_t operator[](std::int32_t level) const { return count_[std::size_t(level - low_)]; }
  /// Code length with an alphabet of `n` symbols.
  Bits bits(std::uint32_t n) const;
  std::uint32_t total() const { return total_; }

 private:
  std::int32_t low_ = 0;
  std::uint32_t total_ = 0;
  std::vector<std::uint32_t> count_;
};

}  // namespace animeme::fba::internal
