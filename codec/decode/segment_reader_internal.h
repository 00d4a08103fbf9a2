// Reads the segments of the arithmetic coder in a plane, and reports invalid bits. Not
// installed API.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "codec/decode/plane_reader_internal.h"
#include "codec/syntax/bits.h"

namespace animeme::fba::internal {

/// The bits that a plane is read from, and the error they give rise to. Borrows the reader.
///
/// Where planes are read the answer is a bool, and the error is kept here: there is one in a stream
/// at most, and many planes.
class PlaneBits {
 public:
  /// `last`: no more bits will come.
  PlaneBits(BitReader& in, bool last) : in_(in), last_(last) {}

  BitReader& in() const { return in_; }
  bool last() const { return last_; }

  /// Notes that the bits have run out: need_data, or truncated. False, as all that note an error.
  bool out_of_bits();
  /// The same, if a read went past the end; else true.
  bool check_end() { return !in_.overrun() || out_of_bits(); }
  /// Notes an error at a bit, unless the offending bits are not there at all.
  bool fail(Code code, std::string message, std::size_t bit);
  /// Reads a bit that has to be 1; `where` it stands.
  bool marker(const char* where);
  /// The error that was noted.
  Error take_error() { return *std::move(error_); }

 private:
  BitReader& in_;
  bool last_;
  std::optional<Error> error_;
};

/// Symbols of the high-level values `first` to `last` into `plane`. At most seven: if they are not
/// all there, they are to be read again from the start. False: there is an error in `bits`.
bool read_high_segment(PlaneBits& bits, const HighLevelState& high, int fap_quant, int first,
                       int last, ParsedPlane& plane);

/// Symbols of the coded slots of one family, which is `parsed` of `plane`. Goes on where the
/// progress of the plane says that it stopped. The models of `state` learn the symbols of
/// predictive planes as they are read. False: there is an error in `bits`.
bool read_slot_segment(PlaneBits& bits, SlotState& state, ParsedSlots& parsed, ParsedPlane& plane);

}  // namespace animeme::fba::internal
