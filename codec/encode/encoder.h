/// @file
/// The FBA encoder that writes plane after plane exactly as it is told. What makes the decisions
/// (masks, ranges, intra planes) is in encode.h for clips and in live.h for streams.
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

/// Before which planes a plane start code (and byte alignment) is written.
enum class PlaneStartCodes : std::uint8_t { none, intra, all };

/// What stands between planes.
struct StreamOptions {
  /// None: planes follow each other bit by bit.
  PlaneStartCodes plane_start_codes = PlaneStartCodes::none;
  bool old_codes = false;  ///< write 00000103 in place of 000001BB before planes
};

/// One plane to be coded. Pointers are borrowed for the call.
struct PlaneInput {
  bool intra = false;                           ///< carries settings, and a decoder can begin here
  ObjectMask object_mask = ObjectMask::face;    ///< what is coded of the values given
  TemporalHeader temporal;                      ///< rate and time code in intra planes only
  const FaceSettings* face_settings = nullptr;  ///< intra planes with a face
  const BodySettings* body_settings = nullptr;  ///< intra planes with a body
  const fap::Frame* face = nullptr;             ///< values of the coded FAPs; its mask is ignored
  const BodyFrame* body = nullptr;              ///< values of the coded BAPs; its mask is ignored
};

/// Writes a stream plane by plane, as the known reference encoder does: object start code, planes
/// bit after bit (or behind start codes), stuffing, end code. Source: codec/bitstream.md, sections
/// 1 to 7.
class Encoder {
 public:
  /// An encoder at the begin of a stream.
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

  /// The values that a decoder has after the last plane (quantised), mask = what was coded.
  const fap::Frame& reconstruction() const;
  /// The same of the body.
  BodyFrame body_reconstruction() const;

  /// Bits written so far, start codes included.
  std::int64_t bits() const;
  /// Whole bytes written since the last take(); the bits of an unfinished byte stay.
  std::vector<std::uint8_t> take();
  /// The same into a vector that is used again and again: copied, nothing is allocated in the end.
  void take(std::vector<std::uint8_t>& bytes);
  /// Stuffing and the end code; the encoder is then used up.
  void end();
  /// end() and take().
  std::vector<std::uint8_t> finish();

  /// Fills the last byte, so that take() gives whole planes, as packets want them. The next plane
  /// has to have a start code (StreamOptions), else write() says invalid_argument.
  void end_unit();

  /// What in the bytes not taken yet can lead other decoders astray although it is legal, as a
  /// sentence; nothing if all is well. Three things: 23 zeros and a 1 inside a plane, which is a
  /// start code for those who scan; 22 zeros from a segment into the 14 bits behind it, on which
  /// the reference decoder loses its place; and a plane without face and body whole in the byte in
  /// front of a start code, which is lost as stuffing (others that short skip 0 frames, which makes
  /// them longer). Call it behind end_unit() or end(), or behind any plane: then what can follow
  /// is reckoned with. Source: codec/bitstream.md, sections 1 and 17.
  std::optional<std::string> trap() const;
  /// Where all of them are, ascending, on the scale of bits().
  std::vector<std::int64_t> trap_bits() const;
  /// Forgets what was written since the last take(), or since the begin. The next plane has to be
  /// intra and to send all four range sets.
  void drop();

 private:
  struct Place;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
