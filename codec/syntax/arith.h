/// @file
/// The arithmetic coder of the FBA stream: 16-bit registers, binary renormalisation, a stuffed 1
/// after 22 zeros. Source: codec/bitstream.md, section 4.
///
/// The description renormalises bit by bit. This implementation does all shifts of a symbol at
/// once: the n leading bits that the registers share are shifted out, then the m bits after the
/// first in which low is 01.. and high is 10... The bits written and read are the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/syntax/adaptive_model.h"
#include "codec/syntax/bits.h"

namespace animeme::fba {

inline constexpr int kStuffingRun = 22;  ///< zeros after which a 1 is stuffed

/// Writes one segment: encode() every symbol, then flush().
class SegmentEncoder {
 public:
  explicit SegmentEncoder(BitWriter& out) : out_(out) {}  ///< `out` is borrowed
  void encode(const SymbolInterval& symbol);              ///< writes one symbol
  /// Ends the segment (an empty one is the two bits 01).
  void flush();

 private:
  void emit(std::uint32_t bits, int count);
  void put(std::uint32_t bits, int count);

  BitWriter& out_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFF;
  std::uint32_t pending_ = 0;
  int zeros_ = 0;
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
  bool ready() const { return taken_ != 0; }
  /// Position in 0..total-1 for a model of that total.
  std::uint32_t target(std::uint32_t total) const {
    return ((value_ - low_ + 1) * total - 1) / (high_ - low_ + 1);
  }
  /// Removes a symbol whose interval was found with target(); false if there are too few bits.
  [[nodiscard]] bool consume(const SymbolInterval& symbol);

  /// Bit position just past the segment if it ended now.
  std::size_t end() const { return position_behind(taken_ - 14); }
  /// Bit position of the first missing stuffed bit inside the segment, which means damaged data;
  /// SIZE_MAX if there is none.
  std::size_t bad_stuffing() const { return bad_stuffing_ < end() ? bad_stuffing_ : SIZE_MAX; }

 private:
  void fill();
  bool fill_bit_by_bit();
  void open_window();
  std::uint32_t take(int count);
  std::size_t position_behind(std::size_t bits) const;

  BitReader in_;
  std::size_t begin_;
  bool last_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFF;
  std::uint32_t value_ = 0;  // the window
  std::size_t taken_ = 0;    // code bits that have entered the window
  std::uint64_t ahead_ = 0;  // code bits to come, left-aligned
  int ahead_bits_ = 0;       // their number
  int zeros_ = 0;            // run of zeros before the next bit of in_
  std::size_t stuffed_ = 0;  // stuffed bits dropped so far
  std::size_t bad_stuffing_ = SIZE_MAX;
  // Number of code bits before each of the latest stuffed ones. At most 64 + 14 bits have been
  // read past the end of the segment, so no more than 4 lie there.
  std::array<std::size_t, 4> stuffed_at_{};
};

}  // namespace animeme::fba
