/// @file
/// The encoder for live streams: one frame in, one access unit out.
///
///     animeme::fba::LiveEncoder encoder({.fap_quant = 2});
///     for (;;) {
///       auto unit = encoder.write(next_frame());      // bytes of one plane, byte aligned
///       if (!unit) return unit.error();
///       send(*unit);
///     }
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "codec/encode/encoder.h"
#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// Predictive ranges by FAP number: the 5-bit number m of the stream, m * 60 / fap_quant levels.
using PredictiveRanges = std::array<std::uint8_t, fap::kFapCount + 1>;

/// The ranges that cover the differences between frames of a clip at a quantiser: of a known clip,
/// or of an example of the source.
PredictiveRanges ranges_of(const fap::Sequence& clip, int fap_quant);

/// All settings of LiveEncoder.
struct LiveOptions {
  fap::Rate rate{25, 1};  ///< planes per second, in every intra plane
  int fap_quant = 1;      ///< 0..31
  int bap_quant = 1;      ///< 0..31, index into kBapScale
  /// Distance of intra planes, where a receiver can join, in seconds (skipped frames count); 0:
  /// only where needed.
  double intra_seconds = 2;
  /// FAPs to be coded; others are ignored. nullopt: those that have occurred so far, so that a new
  /// one triggers an intra plane.
  std::optional<fap::Mask> faps;
  /// Initial ranges of differences between planes; larger differences widen them permanently.
  /// nullopt: adapted at each intra plane to 1.5 times the largest differences of the last two
  /// periods, initially those of the standard.
  std::optional<PredictiveRanges> ranges;
  /// All: every unit is byte aligned and can be cut out, as packets and containers require. Other
  /// values are for files and byte streams that are read contiguously: planes follow each other bit
  /// by bit, which saves some 36 bits per plane; with `intra`, receivers join at the next start
  /// code.
  PlaneStartCodes plane_start_codes = PlaneStartCodes::all;
  bool old_codes = false;  ///< plane start codes of the 1999 edition
  bool verify = true;      ///< decode every unit again and compare
  /// FAPs of lids, eyes, brows, cheeks, nose and ears on the right side that have equalled those of
  /// the left side in all frames so far are not sent: receivers mirror them (mask type 2,
  /// codec/bitstream.md, section 3.1), and reconstruction() does not have them. With the first
  /// frame in which one differs an intra plane sends it, and from there on all planes.
  bool mirror = false;
  /// > 0: each frame is coded so many seconds (rounded to whole frames) after it was written. Intra
  /// planes then know what follows and get the tightest ranges, as of encode() with live_options();
  /// with a shorter delay than the distance of intra planes only as far as it reaches.
  double delay_seconds = 0;
};

/// Encoder of one live stream. Movable, not copyable, not thread safe. A unit depends only on the
/// frames given so far. Memory does not grow with the stream.
class LiveEncoder {
 public:
  explicit LiveEncoder(const LiveOptions& options = {});  ///< checked with the first frame
  LiveEncoder(LiveEncoder&&) noexcept;                    ///< movable
  LiveEncoder& operator=(LiveEncoder&&) noexcept;
  ~LiveEncoder();

  /// Encodes one frame; absent FAPs keep their last value. The number of the frame is not used:
  /// frames follow each other at the rate, and `skip` is the number of frames that will be missing
  /// after this one. `body` may be null; once given, it is held when it is missing.
  ///
  /// Returns the access unit: plane start code, plane, stuffing. The first one begins with the
  /// object start code. Unless all planes have start codes: the complete bytes, possibly none; the
  /// remaining bits come with the next plane or finish(). An intra plane is written when the period
  /// is over, when a FAP or the body is new, and when a difference does not fit its range; it
  /// carries rate, masks and all ranges, so receivers can join there. A value beyond +-1860
  /// quantiser steps that no predictive plane reaches becomes the nearest that an intra plane can
  /// code.
  ///
  /// Errors, after which the next frame can be written as if this one had not been given:
  ///   invalid_argument  options out of bounds, a rate that the format cannot express
  ///   out_of_range      without quantisation, a value beyond +-1860; a viseme outside 0..14, an
  ///                     expression outside 0..6, a blend or an intensity outside 0..63, or values
  ///                     that would be rounded to more than 32 bits; the message names it
  ///   internal          verify failed
  Result<std::vector<std::uint8_t>> write(const fap::Frame& frame, std::uint32_t skip = 0,
                                          const BodyFrame* body = nullptr);
  /// The same into a reused vector: nothing is allocated once the stream has run for a while. On
  /// errors other than `internal` the vector is unchanged.
  Result<void> write(const fap::Frame& frame, std::vector<std::uint8_t>& unit,
                     std::uint32_t skip = 0, const BodyFrame* body = nullptr);
  /// With LiveOptions::delay_seconds write() returns the unit of an earlier frame, and an empty one
  /// until there is such a frame; errors other than invalid_argument are about that frame, too.
  /// Here is how many frames wait for their units.
  std::size_t held() const;
  /// The unit of the first frame that waits, at the end of a stream; empty if none does. Errors as
  /// write().
  Result<void> write_held(std::vector<std::uint8_t>& unit);
  /// The units of all frames that wait, except of those that cannot be coded, the rest of the last
  /// plane and the end code, to end the stream.
  std::vector<std::uint8_t> finish();

  /// The values of receivers after the last unit: quantised, mask = what was coded.
  const fap::Frame& reconstruction() const;
  /// True if the last unit is an intra plane.
  bool intra() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
