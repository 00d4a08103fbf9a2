/// @file
/// Adaptive symbol frequencies of the arithmetic coder. Source: codec/bitstream.md, section 4.
#pragma once

#include <cstdint>
#include <vector>

namespace animeme::fba {

inline constexpr std::uint32_t kMaxTotal = 16383;  ///< frequencies are halved at this total

/// The subinterval of a symbol: `low` to `high` of `total`, as cumulative counts from the low end.
struct SymbolInterval {
  std::uint32_t low = 0;    ///< first count of the symbol
  std::uint32_t high = 1;   ///< one past its last count, > low
  std::uint32_t total = 1;  ///< of all symbols, 1..16383
};

/// Interval of symbol k in a uniform model of n symbols. Higher symbols are at the low end.
inline SymbolInterval flat_interval(std::uint32_t k, std::uint32_t n) {
  return {n - 1 - k, n - k, n};
}

/// Adaptive frequencies of an alphabet 0..n-1, all 1 at first.
///
/// The table holds the mirrored alphabet (higher symbols first, in interval order) in three levels
/// of sixteen: a byte for each symbol, and running sums over groups of 16 and of 256 symbols.
/// Look-up and update take a fixed number of steps; a search tries the group of the latest symbol
/// and takes two more steps if that fails. Only the excess over 1 is stored, so that halving is a
/// shift; values beyond a byte go to a short overflow list, since a total of 16383 leaves room for
/// at most 63 such symbols. 3721 symbols (ranges of +-1860, the largest alphabet) take 4.2 kB, with
/// a full list 4.5.
class AdaptiveModel {
 public:
  /// Resets to uniform; `n` is 1..3721. The table is allocated on first use, so intra planes in
  /// quick succession cost nothing.
  void reset(std::uint32_t n) {
    n_ = n;
    total_ = n;
    fresh_ = true;
  }
  std::uint32_t size() const { return n_; }       ///< symbols of the alphabet
  std::uint32_t total() const { return total_; }  ///< sum of all frequencies

  /// Interval of symbol k (0..n-1).
  SymbolInterval interval(std::uint32_t k) const;
  /// The symbol whose interval holds `target` (0..total-1), and that interval.
  std::uint32_t find(std::uint32_t target, SymbolInterval& interval) const;
  /// Counts one more occurrence of k; halves all counts first if the total is kMaxTotal.
  void update(std::uint32_t k);

 private:
  // The part of a count that the byte of a symbol cannot hold, a multiple of 256.
  struct Overflow {
    std::uint16_t symbol = 0;  // mirrored
    std::uint16_t excess = 0;
  };

  void build();
  void halve();
  void sum_up();
  void carry(std::uint32_t mirrored);
  // False: no symbol of the group is in the overflow list. May be true without one.
  bool may_overflow(std::uint32_t group) const { return ((overflowing_ >> (group & 63)) & 1) != 0; }

  std::uint32_t n_ = 1;
  std::uint32_t total_ = 1;
  bool fresh_ = true;             // uniform, table not built
  std::uint32_t last_group_ = 0;  // group of the latest symbol
  // 16 sums over the 256s, then 16 for each of them over its 16s: the frequencies below each
  // within its parent. Those past the alphabet are larger than any target.
  std::vector<std::int16_t> below_;
  std::vector<std::uint8_t> excess_;  // frequency - 1, modulo 256; whole groups of 16
  std::vector<Overflow> overflow_;
  std::uint64_t overflowing_ = 0;  // bit g & 63 for each group g in the list
};

}  // namespace animeme::fba
