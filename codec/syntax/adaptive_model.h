/// @file
/// Adaptive symbol frequencies of the arithmetic coder. Source: codec/bitstream.md, section 4.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
/// The table holds the mirrored alphabet, higher symbols first, in interval order. Up to 128
/// symbols (most streams have no more) it is a line of running sums: an interval is two of them, an
/// update adds to all behind it, and a search tries sixteen around the latest symbol first, all at
/// once.
///
/// Larger alphabets have three levels of sixteen: a byte for each symbol, and running sums over
/// groups of 16 and of 256 symbols. Look-up and update take a fixed number of steps; a search tries
/// the group of the latest symbol and takes two more steps if that fails. Only the excess over 1 is
/// stored, so that halving is a shift; values beyond a byte go to a short overflow list, since a
/// total of 16383 leaves room for at most 63 such symbols. 3721 symbols (ranges of +-1860, the
/// largest alphabet) take 4.2 kB, with a full list 4.5.
class AdaptiveModel {
 public:
  /// Resets to uniform; `n` is 1..3721. The table is allocated on first use, so intra planes in
  /// quick succession cost nothing.
  void reset(std::uint32_t n) {
    n_ = n;
    total_ = n;
    table_ = Table::none;
  }
  std::uint32_t size() const { return n_; }       ///< symbols of the alphabet
  std::uint32_t total() const { return total_; }  ///< sum of all frequencies

  /// Interval of symbol k (0..n-1).
  [[gnu::always_inline]] SymbolInterval interval(std::uint32_t k) const {
    if (table_ != Table::line) return interval_otherwise(k);
    const std::int16_t* sums = &below_[n_ - 1 - k];
    return {std::uint32_t(sums[0]), std::uint32_t(sums[1]), total_};
  }
  /// The symbol whose interval holds `target` (0..total-1), and that interval.
  [[gnu::always_inline]] std::uint32_t find(std::uint32_t target, SymbolInterval& interval) const {
    if (table_ != Table::line) return find_otherwise(target, interval);
    const std::int16_t* sums = below_.data();
    std::uint32_t mirrored = last_;
    // A parameter at rest repeats its symbol: where that is foreseen, the processor goes on with it
    // while the target is still being divided.
    if (repeats_ < kRest || target < std::uint32_t(sums[mirrored]) ||
        target >= std::uint32_t(sums[mirrored + 1])) {
      const std::int16_t* near = sums + near_;
      const bool is_near = target >= std::uint32_t(near[0]) && target < std::uint32_t(near[kNear]);
      mirrored = is_near ? near_ + last_of_near(near, target) : last_of_all(target);
    }
    interval = {std::uint32_t(sums[mirrored]), std::uint32_t(sums[mirrored + 1]), total_};
    return n_ - 1 - mirrored;
  }
  /// Counts one more occurrence of k; halves all counts first if the total is kMaxTotal.
  [[gnu::always_inline]] void update(std::uint32_t k) {
    if (table_ != Table::line || total_ >= kMaxTotal) return update_otherwise(k);
    const std::uint32_t mirrored = n_ - 1 - k;
    std::int16_t* sums = below_.data();
    const std::int16_t* more = &kMore[kLine - 1 - mirrored];
    const std::size_t size = below_.size();
    // The sums up to the symbol stay.
    for (std::size_t i = (mirrored + 1) & ~(2 * kBlock - 1); i < size; i += 2 * kBlock) {
      add_block(sums + i, more + i);
      add_block(sums + i + kBlock, more + i + kBlock);
    }
    ++total_;
  }
  /// Lets find() look for k first, without effect on what it finds: for decoders, behind update().
  [[gnu::always_inline]] void expect(std::uint32_t k) {
    const std::uint32_t mirrored = n_ - 1 - k;
    near_ = n_ <= kNear ? 0 : std::min(mirrored < kNear / 2 ? 0 : mirrored - kNear / 2, n_ - kNear);
    repeats_ = (repeats_ + 1) & (0U - std::uint32_t(mirrored == last_));  // 0 behind another one
    last_ = mirrored;
  }

 private:
  enum class Table : std::uint8_t { none, line, levels };

  // The part of a count that the byte of a symbol cannot hold, a multiple of 256.
  struct Overflow {
    std::uint16_t symbol = 0;  // mirrored
    std::uint16_t excess = 0;
  };

  static constexpr std::uint32_t kLargestLine = 128;  // symbols of the largest alphabet in a line
  using Block = std::int16_t __attribute__((vector_size(16)));
  static constexpr std::uint32_t kBlock = 8;
  static constexpr std::uint32_t kRest = 3;   // repeats that promise more of them
  static constexpr std::uint32_t kNear = 16;  // symbols that a search tries first
  static constexpr std::uint32_t kLine = kLargestLine + 2 * kBlock;
  static const std::array<std::int16_t, 2 * kLine> kMore;

  [[gnu::always_inline]] static void add_block(std::int16_t* sums, const std::int16_t* more) {
    Block block;
    Block steps;
    std::memcpy(&block, sums, sizeof block);
    std::memcpy(&steps, more, sizeof steps);
    block += steps;
    std::memcpy(sums, &block, sizeof block);
  }

  // Index of the last of sixteen ascending sums that is not above the target; the first one is not.
  [[gnu::always_inline]] static std::uint32_t last_of_near(const std::int16_t* near,
                                                           std::uint32_t target) {
    // Four lanes of 16 bits in a number: with its highest bit set, a lane keeps that bit where what
    // is taken away is not above the target. How the lanes are ordered makes no difference.
    constexpr std::uint64_t kLanes = 0x0001000100010001U;
    const std::uint64_t targets = (target | 0x8000U) * kLanes;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < kNear; i += 4) {
      std::uint64_t sums = 0;
      std::memcpy(&sums, near + i, sizeof sums);
      count += ((targets - sums) >> 15) & kLanes;
    }
    return std::uint32_t((count * kLanes) >> 48) - 1;
  }

  SymbolInterval interval_otherwise(std::uint32_t k) const;
  std::uint32_t find_otherwise(std::uint32_t target, SymbolInterval& interval) const;
  void update_otherwise(std::uint32_t k);
  std::uint32_t last_of_all(std::uint32_t target) const;
  void build();
  void halve();
  void halve_line();
  void sum_up();
  void carry(std::uint32_t mirrored);
  // False: no symbol of the group is in the overflow list. May be true without one.
  bool may_overflow(std::uint32_t group) const { return ((overflowing_ >> (group & 63)) & 1) != 0; }

  std::uint32_t n_ = 1;
  std::uint32_t total_ = 1;
  Table table_ = Table::none;     // none: uniform, not built
  std::uint32_t near_ = 0;        // of a line, where the sixteen sums to be tried first begin
  std::uint32_t last_ = 0;        // of a line, the latest symbol, mirrored
  std::uint32_t repeats_ = 0;     // how often it came again in a row
  std::uint32_t last_group_ = 0;  // of levels, group of the latest symbol
  // A line: the frequencies below each symbol, then their total; whole blocks, and seventeen sums
  // at least. Levels: 16 sums over the 256s, then 16 for each of them over its 16s, the frequencies
  // below each within its parent. What lies past the alphabet is larger than any target.
  std::vector<std::int16_t> below_;
  std::vector<std::uint8_t> excess_;  // of levels: frequency - 1, modulo 256; whole groups of 16
  std::vector<Overflow> overflow_;
  std::uint64_t overflowing_ = 0;  // bit g & 63 for each group g in the list
};

}  // namespace animeme::fba
