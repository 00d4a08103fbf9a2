// Reads the segments of the arithmetic coder in a plane, and reports invalid bits. Not
// installed API.
#pragma once

#include <cstddef>
#include <string>

#include "codec/decode/plane_reader_internal.h"
#include "codec/syntax/bits.h"

namespace animeme::fba::internal {

/// The bits that a plane is read from, and the errors they give rise to. Borrows the reader.
class PlaneBits {
 public:
  /// `last`: no more bits will come.
  PlaneBits(BitReader& in, bool last) : in_(in), last_(last) {}

  BitReader& in() const { return in_; }
  bool last() const { return last_; }

  /// The error when the bits have run out: need_data, or truncated.
  Error out_of_bits() const;
  /// The same, if a read went past the end.
  Result<void> check_end() const {
    if (!in_.overrun()) return {};
    return out_of_bits();
  }
  /// An error at a bit, unless the offending bits are not there at all.
  Error fail(Code code, std::string message, std::size_t bit) const;
  /// Reads a bit that has to be 1; `where` it stands.
  Result<void> marker(const char* where) const;

 private:
  BitReader& in_;
  bool last_;
};

/// Symbols of the high-level values `first` to `last` into `plane`. At most seven: if they are not
/// all there, they are to be read again from the start.
Result<void> read_high_segment(const PlaneBits& bits, const HighLevelState& high, int fap_quant,
                               int first, int last, ParsedPlane& plane);

/// Symbols of the coded slots of one family. Goes on where `progress` says that it stopped. The
/// models of `state` learn the symbols of predictive planes as they are read.
Result<void> read_slot_segment(const PlaneBits& bits, SlotState& state, bool intra,
                               PlaneProgress& progress, ParsedSlots& parsed);

}  // namespace animeme::fba::internal
