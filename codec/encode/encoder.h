/// @file
/// The low-level FBA encoder: writes each plane exactly as specified. The decisions (masks, ranges,
/// intra planes) are made in encode.h for clips and in live.h for streams.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// The planes that get a plane start code (and byte alignment).
enum class PlaneStartCodes : std::uint8_t { none, intra, all };

/// Separation of planes.
struct StreamOptions {
  /// None: planes are bit-contiguous.
  PlaneStartCodes plane_start_codes = PlaneStartCodes::none;
  bool old_codes = false;  ///< write 00000103 in place of 000001BB before planes
};

/// One plane to be coded. Pointers are borrowed for the call.
struct PlaneInput {
  bool intra = false;                           ///< carries settings, and a decoder can start here
  ObjectMask object_mask = ObjectMask::face;    ///< which of the given values are coded
  TemporalHeader temporal;                      ///< rate and time code in intra planes only
  const FaceSettings* face_settings = nullptr;  ///< intra planes with a face
  const BodySettings* body_settings = nullptr;  ///< intra planes with a body
  const fap::Frame* face = nullptr;             ///< values of the coded FAPs; its mask is ignored
  const BodyFrame* body = nullptr;              ///< values of the coded BAPs; its mask is ignored
};

/// Writes a stream plane by plane, like the known reference encoder: object start code, planes
/// bit-contiguous (or behind start codes), stuffing, end code. Source: codec/bitstream.md, sections
/// 1 to 7.
class Encoder {
 public:
  /// An encoder at the beginning of a stream.
  explicit Encoder(const StreamOptions& options = {});
  Encoder(Encoder&&) noexcept;  ///< movable
  Encoder& operator=(Encoder&&) noexcept;
  ~Encoder();

  /// Codes one plane. On an error nothing is written and the state is as before:
  ///   invalid_argument  settings out of bounds (quantiser 0..31, ranges 0..31, masks that do not
  ///                     agree with their types, intra settings missing), or a predictive plane
  ///                     before the first intra plane of its kind
  ///   out_of_range      a value's level does not fit the range in force, or its reconstruction
  ///                     32 bits; the message names it
  Result<void> write(const PlaneInput& plane);

  /// The values of a decoder after the last plane (quantised), mask = what was coded.
  const fap::Frame& reconstruction() const;
  /// The same for the body.
  BodyFrame body_reconstruction() const;

  /// Bits written so far, start codes included.
  std::int64_t bits() const;
  /// Whole bytes written since the last take(); the bits of an unfinished byte stay.
  std::vector<std::uint8_t> take();
  /// The same into a reused vector: once its capacity suffices, nothing is allocated.
  void take(std::vector<std::uint8_t>& bytes);
  /// Writes stuffing and the end code; the encoder cannot be used afterwards.
  void end();
  /// end() and take().
  std::vector<std::uint8_t> finish();

  /// Fills the last byte, so that take() gives whole planes, as packets require. The next plane
  /// must have a start code (StreamOptions), else write() returns invalid_argument.
  void end_unit();

  /// A hazard in the bytes not taken yet: a legal pattern that can mislead other decoders,
  /// described in a sentence; nullopt if there is none. Three patterns are hazards: 23 zeros and a
  /// 1 inside a plane, a start code to programs that scan for one; 22 zeros from a segment into the
  /// 14 bits behind it, on which the reference decoder loses sync; and a plane without face and
  /// body entirely within the byte before a start code, which is lost as stuffing (other planes
  /// that short skip 0 frames, which makes them longer). Call it after end_unit() or end(), or
  /// after any plane; then it considers every possible continuation. Source: codec/bitstream.md,
  /// sections 1 and 17.
  std::optional<std::string> hazard() const;
  /// Positions of all hazards, ascending, on the scale of bits().
  std::vector<std::int64_t> hazard_bits() const;
  /// Discards what was written since the last take(), or since the beginning. The next plane must
  /// be intra and send all four range sets.
  void drop();

 private:
  struct Place;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
