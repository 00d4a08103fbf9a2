/// @file
/// The arithmetic coder of the FBA stream: 16-bit registers, binary renormalisation, a stuffed 1
/// after 22 zeros. Source: codec/bitstream.md, section 4.
///
/// The description renormalises bit by bit. This implementation does all shifts of a symbol at
/// once, and keeps what has been shifted out of the encoder's low register in the same number, so
/// that bits which wait for their value are settled by a carry. The bits written and read are the
/// same.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/syntax/adaptive_model.h"
#include "codec/syntax/bits.h"

namespace animeme::fba {

inline constexpr int kStuffingRun = 22;  ///< zeros after which a 1 is stuffed

/// length * count / total of the description, for many counts of one symbol: the length times a
/// reciprocal of the total that is too large by at most 2 / 2^46 parts of one. The quotient is
/// exact, since length * count is at most 2^16 * total and total is below 2^14.
class Scale {
 public:
  /// For symbols of a total that share `length`.
  [[gnu::always_inline]] Scale(std::uint32_t length, std::uint32_t total)
      : factor_(length * (std::uint64_t(std::int64_t(0x1p46 / double(std::int32_t(total)))) + 1)) {}
  /// length * count / total.
  [[gnu::always_inline]] std::uint32_t operator()(std::uint32_t count) const {
    return std::uint32_t((factor_ * count) >> 46);
  }

 private:
  std::uint64_t factor_;
};

/// The number of shifts that follow a symbol which has left `length` values from `low` on.
///
/// An interval that is no longer than a quarter of the registers is always shifted, one that is
/// longer than half of them never. In between it is, unless it crosses the middle and one of the
/// quarters. What the shifts before did to the highest bit of `low` does not matter for that.
[[gnu::always_inline]] inline int shifts_of(std::uint32_t low, std::uint32_t length) {
  const int most = std::countl_zero(length - 1) - 16;
  const std::uint32_t end = ((low << most) & 0x7FFFU) + (length << most);
  return most - (end > 0x10000U ? 1 : 0);
}

/// Writes one segment: encode() every symbol, then flush().
class SegmentEncoder {
 public:
  explicit SegmentEncoder(BitWriter& out) : out_(out) {}  ///< `out` is borrowed
  /// Writes one symbol.
  void encode(const SymbolInterval& symbol) {
    encode(1, [&symbol](std::size_t) { return symbol; });
  }
  /// Writes `count` symbols: those whose intervals `next(0)`, `next(1)`, ... returns.
  template <class Next>
  [[gnu::always_inline]] void encode(std::size_t count, const Next& next) {
    Registers now = now_;  // a copy that nothing else can reach stays in the processor
    for (std::size_t i = 0; i < count; ++i) {
      const SymbolInterval symbol = next(i);
      const Scale scale(now.length, symbol.total);
      const std::uint32_t begin = scale(symbol.low);
      const std::uint32_t length = scale(symbol.high) - begin;
      const int shift = shifts_of((std::uint32_t(now.low) & 0x7FFFU) + begin, length);
      now.low = (now.low + begin) << shift;
      now.length = length << shift;
      now.bits += shift;
      if (now.bits >= 32) {
        now.bits -= 32;
        add_word(now.low >> (now.bits + 16));
        now.low &= (std::uint64_t(1) << (now.bits + 16)) - 1;
      }
    }
    now_ = now;
  }
  /// Ends the segment (an empty one is the two bits 01). Returns how many zeros are at its end.
  int flush() {
    // What a short one has, unless a 1 may have to be stuffed.
    const std::uint64_t rest = (now_.low + 0x4000U) >> 14;
    const int count = now_.bits + 2;
    if (waiting_ || zeros_ != 0 || count > kStuffingRun || rest >> count != 0 || rest == 0) {
      return flush_any();
    }
    now_ = {};
    out_.bits(std::uint32_t(rest), count);
    return std::countr_zero(std::uint32_t(rest));
  }

 private:
  struct Registers {
    // The 16-bit register, whose highest bit is 0 where it counts alone, and above it the bits that
    // have been shifted out and not been handed on; a carry into them may come.
    std::uint64_t low = 0;
    std::uint32_t length = 0x10000;  // high - low + 1
    int bits = 0;                    // above the 16
  };

  int flush_any();
  void add_word(std::uint64_t word);
  void settle(std::uint32_t carry);
  void put_word(std::uint32_t word);
  void put(std::uint32_t bits, int count);

  BitWriter& out_;
  Registers now_;
  bool waiting_ = false;    // a word may still get a carry
  std::uint32_t word_ = 0;  // that word
  std::size_t ones_ = 0;    // words of ones alone behind it
  int zeros_ = 0;
};

/// The registers of a SegmentDecoder, to be copied where a loop over symbols begins and put back
/// behind it.
class SegmentCursor {
 public:
  /// Position in 0..total-1 for a model of that total.
  [[gnu::always_inline]] std::uint32_t target(std::uint32_t total) const {
    return ((offset_ + 1) * total - 1) / length_;
  }
  /// Removes the symbol with these counts of a total; false, without a change, if there are too few
  /// bits.
  [[nodiscard, gnu::always_inline]] bool consume(std::uint32_t low, std::uint32_t high,
                                                 std::uint32_t total) {
    const Scale scale(length_, total);
    const std::uint32_t begin = scale(low);
    const std::uint32_t length = scale(high) - begin;
    const int shift = shifts_of(low_ + begin, length);
    if (shift > ahead_bits_) return false;
    low_ = ((low_ + begin) << shift) & 0x7FFFU;
    length_ = length << shift;
    offset_ = (offset_ - begin) << shift | take(shift);
    return true;
  }
  /// Whether the symbols so far are the same whatever follows a segment that ends here: its last
  /// two bits say where in the interval the value lies, as flush() of an encoder writes them.
  bool settled() const {
    const std::uint32_t quarter = (low_ + offset_) & ~0x3FFFU;
    return quarter >= low_ && quarter + 0x4000U <= low_ + length_;
  }
  /// There are fewer bits ahead than a symbol can take: SegmentDecoder::refill() is due.
  bool needs_bits() const { return ahead_bits_ < 16; }

 private:
  friend class SegmentDecoder;

  // Up to 16 bits from the front of those ahead.
  [[gnu::always_inline]] std::uint32_t take(int count) {
    const std::uint32_t bits = std::uint32_t((ahead_ >> 1) >> (63 - count));
    ahead_ <<= count;
    ahead_bits_ -= count;
    taken_ += std::size_t(count);
    return bits;
  }

  std::uint32_t low_ = 0;           // of the interval, without what waits for a carry
  std::uint32_t length_ = 0x10000;  // high - low + 1
  std::uint32_t offset_ = 0;        // of the window from `low`
  int ahead_bits_ = 0;              // their number
  std::uint64_t ahead_ = 0;         // code bits to come, left-aligned
  std::size_t taken_ = 0;           // code bits that have entered the window
};

/// Reads one segment. The 16-bit window looks 14 bits past the end of the segment; those bits
/// belong to other fields, so neither their zero runs nor their absence may count as an error.
/// Therefore the positions of the latest stuffed bits are kept, and a missing one is an error only
/// if it is inside the segment.
///
/// Input may arrive in pieces: while more may follow, missing bits are not replaced, and consume()
/// reports that there are too few. The state is then unchanged; call resume() when there are more.
class SegmentDecoder {
 public:
  /// Starts at the position of `in`, which is not moved. `last`: nothing follows the bytes of `in`,
  /// bits past the end are zeros.
  explicit SegmentDecoder(const BitReader& in, bool last = true)
      : in_(in), begin_(in.position()), last_(last) {
    fill();
    open_window();
  }
  /// Continues at the same bit with the same bytes and more after them.
  void resume(std::span<const std::uint8_t> bytes, bool last) {
    in_ = BitReader(bytes, in_.position());
    last_ = last;
    fill();
    if (!ready()) open_window();
  }

  /// False: there are too few bits for a first symbol.
  bool ready() const { return cursor_.taken_ != 0; }
  /// Position in 0..total-1 for a model of that total.
  std::uint32_t target(std::uint32_t total) const { return cursor_.target(total); }
  /// Removes a symbol whose interval was found with target(); false if there are too few bits.
  [[nodiscard]] bool consume(const SymbolInterval& symbol) {
    if (!cursor_.consume(symbol.low, symbol.high, symbol.total)) return false;
    if (cursor_.needs_bits()) fill();
    return true;
  }

  /// Where the reading stands; symbols may be consumed from a copy.
  const SegmentCursor& cursor() const { return cursor_; }
  /// Goes on where such a copy stands.
  void set_cursor(const SegmentCursor& cursor) { cursor_ = cursor; }
  /// Bits for a copy that needs some.
  void refill(SegmentCursor& cursor) {
    cursor_ = cursor;
    fill();
    cursor = cursor_;
  }

  /// Bit position just past the segment if it ended now.
  std::size_t end() const { return position_behind(cursor_.taken_ - 14); }
  /// Bit position of the first missing stuffed bit inside the segment, which means damaged data;
  /// SIZE_MAX if there is none.
  std::size_t bad_stuffing() const { return bad_stuffing_ < end() ? bad_stuffing_ : SIZE_MAX; }

 private:
  void fill();
  bool fill_bit_by_bit();
  void open_window() {
    if (cursor_.ahead_bits_ >= 16) cursor_.offset_ = cursor_.take(16);
  }
  std::size_t position_behind(std::size_t bits) const;

  BitReader in_;
  std::size_t begin_;
  bool last_;
  SegmentCursor cursor_;
  int zeros_ = 0;            // run of zeros before the next bit of in_
  std::size_t stuffed_ = 0;  // stuffed bits dropped so far
  std::size_t bad_stuffing_ = SIZE_MAX;
  // Number of code bits before each of the latest stuffed ones. At most 64 + 14 bits have been
  // read past the end of the segment, so no more than 4 lie there.
  std::array<std::size_t, 4> stuffed_at_{};
};

}  // namespace animeme::fba
