// The FBA encoder.
//
// Two levels: Encoder writes plane after plane exactly as it is told; encode() takes a clip and
// makes the decisions (masks, ranges, intra planes) itself.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "codec/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// Before which planes a plane start code (and byte alignment) is written.
enum class PlaneStartCodes : std::uint8_t { none, intra, all };

struct StreamOptions {
  PlaneStartCodes plane_start_codes = PlaneStartCodes::none;
  bool old_codes = false;  ///< write 00000103 in place of 000001BB before planes
};

/// One plane to be coded. Pointers are borrowed for the call.
struct PlaneInput {
  bool intra = false;
  ObjectMask object_mask = ObjectMask::face;
  TemporalHeader temporal;                      ///< rate and time code in intra planes only
  const FaceSettings* face_settings = nullptr;  ///< intra planes with a face
  const BodySettings* body_settings = nullptr;  ///< intra planes with a body
  const fap::Frame* face = nullptr;             ///< values of the coded FAPs; its mask is ignored
  const BodyFrame* body = nullptr;              ///< values of the coded BAPs; its mask is ignored
};

/// Writes a stream plane by plane, as the known reference encoder does: object start code, planes
/// bit after bit (or behind start codes), stuffing, end code. Source: fba_bitstream, 1 to 7.
class Encoder {
 public:
  explicit Encoder(const StreamOptions& options = {});
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;
  ~Encoder();

  /// Codes one plane. On an error nothing is written and the state is as before:
  ///   invalid_argument  settings out of bounds (quantiser 0..31, ranges 0..31, masks that do not
  ///                     agree with their types, intra settings missing), or a predictive plane
  ///                     before the first intra plane of its kind
  ///   out_of_range      a value's level does not fit the range in force; the message names it
  Result<void> write(const PlaneInput& plane);

  /// The values that a decoder has after the last plane (quantised), mask = what was coded.
  fap::Frame reconstruction() const;

  /// Bits written so far, start codes included.
  std::int64_t bits() const;
  /// Whole bytes written since the last take(); the bits of an unfinished byte stay.
  std::vector<std::uint8_t> take();
  /// Stuffing and the end code; returns what is left. The encoder is then used up.
  std::vector<std::uint8_t> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decisions left to encode().
struct EncodeOptions {
  int fap_quant = 1;     ///< 0..31; 1: the standard's steps, 0: lossless for values up to +-1860
  int intra_period = 0;  ///< intra plane at least every so many planes; 0: only where needed
  StreamOptions stream;
};

/// Codes a face clip: the FAPs that occur in it, in ranges as tight as the format allows, with an
/// intra plane at the start, every `intra_period` planes, and wherever a change is too large for
/// a predictive plane. A FAP that a frame leaves out keeps its last value (0 at first). Gaps in
/// the frame numbers become skipped frames. Deterministic.
/// Errors: invalid_argument (no frames, numbers that do not ascend, options out of bounds),
/// unsupported (a rate that the format cannot express: use k/16 frames per second up to
/// 255 15/16, or those times 1000/1001), out_of_range (a value beyond 1860 quantiser steps, or a
/// viseme or expression out of its bounds; the message names FAP and frame).
Result<std::vector<std::uint8_t>> encode(const fap::Sequence& clip, const EncodeOptions& = {});

}  // namespace animeme::fba
