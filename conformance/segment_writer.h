/// @file
/// The arithmetic coder written a second time, word for word after the description and with no
/// thought of speed, so that the generated streams do not rest on the codec that they test.
/// Source: codec/bitstream.md, section 4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace animeme::conformance {

/// The bits of a stream, one a byte, most significant first.
struct Bits {
  std::vector<std::uint8_t> bit;  ///< 0 or 1 each

  /// The low `count` bits, highest first.
  void put(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bit.push_back(std::uint8_t((value >> i) & 1U));
  }
  /// 0 and then 1s to the byte border, a whole byte at one.
  void stuff() {
    bit.push_back(0);
    while (bit.size() % 8 != 0) bit.push_back(1);
  }
  /// Whole bytes; the number of bits must be a multiple of 8.
  std::vector<std::uint8_t> bytes() const;
};

/// Frequencies of an alphabet 0..n-1.
struct Frequencies {
  std::vector<std::uint32_t> count;  ///< by symbol, at least 1 each
  bool halved = false;               ///< the total has been at 16383

  /// A flat table of n symbols.
  void reset(int n) {
    count.assign(std::size_t(n), 1);
    halved = false;
  }
  void update(std::size_t symbol);  ///< counts a symbol, see codec/bitstream.md, section 4
};

/// Events while a stream was written that can mislead a decoder.
struct CoderTrace {
  int stuffed = 0;                       ///< 1s put after 22 zeros
  int symbols = 0;                       ///< coded with at least two to choose from
  int empty_segments = 0;                ///< no symbol at all
  int halved = 0;                        ///< models that were halved
  std::vector<std::size_t> segment_end;  ///< bit positions
  std::vector<int> zeros_at_end;         ///< zero run that the coder has counted there
};

/// One segment: encode() every symbol, then flush().
class SegmentWriter {
 public:
  /// `bad_stuffing`: the first stuffed bit is written as 0; it is cleared when that was done.
  SegmentWriter(Bits& out, CoderTrace& trace, bool& bad_stuffing)
      : out_(out), trace_(trace), bad_stuffing_(bad_stuffing) {}
  /// Codes one symbol; the model is not changed.
  void encode(const Frequencies& model, std::size_t symbol);
  void flush();  ///< ends the segment

 private:
  void emit(int bit);
  void put(int bit);

  Bits& out_;
  CoderTrace& trace_;
  bool& bad_stuffing_;
  std::int64_t low_ = 0, high_ = 65535;
  int pending_ = 0;
  int zeros_ = 0;
  int symbols_ = 0;
};

}  // namespace animeme::conformance
