// The arithmetic coder of the FBA stream: 16-bit registers, binary renormalisation, a stuffed 1
// after 22 zeros. Source: fba_bitstream, section 4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/bits.h"

namespace animeme::fba {

inline constexpr std::uint32_t kMaxTotal = 16383;  ///< a model is halved when it reaches this
inline constexpr int kStuffingRun = 22;            ///< zeros after which a 1 is stuffed

/// The part of the unit interval that a symbol owns: `low` to `high` of `total`, as cumulative
/// counts from the low end.
struct SymbolInterval {
  std::uint32_t low = 0;
  std::uint32_t high = 1;
  std::uint32_t total = 1;
};

/// Where symbol k of a flat model of n symbols lies. Higher symbols lie at the low end.
inline SymbolInterval flat_interval(std::uint32_t k, std::uint32_t n) {
  return {n - 1 - k, n - k, n};
}

/// Adaptive frequencies of an alphabet 0..n-1, all 1 at first.
///
/// Counts are kept in a binary indexed tree over the mirrored alphabet (higher symbols first, as
/// the interval wants them), so look-up, search and update take log2(n) steps. n is at most
/// 3721 (ranges of +-1860), a total never exceeds 16383, so 16 bits hold every node.
class AdaptiveModel {
 public:
  AdaptiveModel() = default;

  /// Forgets everything; `n` >= 1. The table itself is made when it is first needed, so that
  /// intra planes in quick succession cost nothing.
  void reset(std::uint32_t n) {
    n_ = n;
    total_ = n;
    fresh_ = true;
  }
  std::uint32_t size() const { return n_; }
  std::uint32_t total() const { return total_; }

  /// Interval of symbol k (0..n-1).
  SymbolInterval interval(std::uint32_t k) const;
  /// The symbol whose interval holds `target` (0..total-1), and that interval.
  std::uint32_t find(std::uint32_t target, SymbolInterval& interval) const;
  /// Counts one more occurrence of k; halves all counts first if the total is kMaxTotal.
  void update(std::uint32_t k);

 private:
  std::uint32_t prefix(std::uint32_t mirrored) const;  // counts of mirrored symbols below
  void build();
  void halve();

  std::uint32_t n_ = 1;
  std::uint32_t total_ = 1;
  bool fresh_ = true;                // flat, tree not built
  std::vector<std::uint16_t> tree_;  // 1-based binary indexed tree
};

/// Writes one segment: encode() every symbol, then flush().
class SegmentEncoder {
 public:
  explicit SegmentEncoder(BitWriter& out) : out_(out) {}
  void encode(const SymbolInterval& symbol);
  /// Ends the segment (an empty one is the two bits 01).
  void flush();

 private:
  void emit(std::uint32_t bit);
  void put(std::uint32_t bit);

  BitWriter& out_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFF;
  std::uint32_t pending_ = 0;
  int zeros_ = 0;
};

/// Reads one segment. The 16-bit window looks 14 bits past the end of the segment; those bits
/// belong to other fields, so neither their zero runs nor their absence may count as an error.
/// Therefore the stream position of each window bit is kept, and a missing stuffed bit is held
/// against the segment only if it lies inside it.
class SegmentDecoder {
 public:
  /// Starts at the position of `in`; `in` is moved by finish() only.
  explicit SegmentDecoder(const BitReader& in);

  /// Position in 0..total-1 for a model of that total.
  std::uint32_t target(std::uint32_t total) const {
    return ((value_ - low_ + 1) * total - 1) / (high_ - low_ + 1);
  }
  /// Removes a symbol whose interval was found with target().
  void consume(const SymbolInterval& symbol);

  /// Bit position just behind the segment, if it ended now.
  std::size_t end() const { return positions_[(next_ + 2 - 1) & 15]; }
  /// Bit position just behind the last bit looked at, inside the segment or not.
  std::size_t window_end() const { return in_.position(); }
  /// True if a stuffed bit inside the segment is not 1: the data are damaged.
  bool bad_stuffing() const { return bad_stuffing_ < end(); }
  std::size_t bad_stuffing_position() const { return bad_stuffing_; }

 private:
  std::uint32_t next_bit();

  BitReader in_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFF;
  std::uint32_t value_ = 0;
  int zeros_ = 0;
  std::size_t bad_stuffing_ = SIZE_MAX;
  std::array<std::size_t, 16> positions_{};  // ring: position behind each window bit
  std::size_t next_ = 0;                     // index of the oldest window bit
};

}  // namespace animeme::fba
