/// @file
/// The encoder for streams that are made while they are sent: one frame in, one access unit out.
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

/// The ranges that hold the changes from frame to frame of a clip at a quantiser: of one that is
/// known, or of an example of what a source can do.
PredictiveRanges ranges_of(const fap::Sequence& clip, int fap_quant);

/// All settings of LiveEncoder.
struct LiveOptions {
  fap::Rate rate{25, 1};  ///< planes a second, in every intra plane
  int fap_quant = 1;      ///< 0..31
  int bap_quant = 1;      ///< 0..31, index into kBapScale
  /// An intra plane, where a receiver can join in, every so many seconds (frames that are skipped
  /// count); 0: only where needed.
  double intra_seconds = 2;
  /// FAPs to be coded; others are ignored. Nothing: those that have occurred so far, so that a
  /// new one brings an intra plane.
  std::optional<fap::Mask> faps;
  /// Ranges of changes from plane to plane to begin with; larger changes than these widen them for
  /// good. Nothing: adapted at each intra plane to the largest changes of the last two periods and
  /// half as much again, at first those of the standard.
  std::optional<PredictiveRanges> ranges;
  /// All: every unit is byte aligned and can be cut out, as packets and containers want it. Else
  /// for files and byte streams that are read in one piece: planes follow each other bit by bit,
  /// which saves some 36 bits a plane; with `intra` those who join find the next start code.
  PlaneStartCodes plane_start_codes = PlaneStartCodes::all;
  bool old_codes = false;  ///< plane start codes of the 1999 edition
  bool verify = true;      ///< decode every unit again and compare
};

/// Encoder of one live stream. Movable, not copyable, not thread safe. No look-ahead: a unit
/// depends on the frames given so far. Memory does not grow with the stream.
class LiveEncoder {
 public:
  explicit LiveEncoder(const LiveOptions& options = {});  ///< checked with the first frame
  LiveEncoder(LiveEncoder&&) noexcept;                    ///< movable
  LiveEncoder& operator=(LiveEncoder&&) noexcept;
  ~LiveEncoder();

  /// Codes one frame; FAPs that it leaves out keep their last value. The number of the frame is
  /// not used: frames follow each other at the rate, and `skip` says how many will be missing
  /// after this one. `body` may be null; once it was given it is held when it is missing.
  ///
  /// Returns the access unit: plane start code, plane, stuffing. The first one begins with the
  /// object start code. Without start codes at all planes: the bytes that are complete, perhaps
  /// none; the bits of the last one come with the next plane or finish(). An intra plane is written
  /// when the period is over, when a FAP or the body is new, and when a change does not fit its
  /// range; it carries rate, masks and all ranges, so receivers can join there. A value beyond
  /// +-1860 quantiser steps that no predictive plane reaches becomes the nearest that an intra
  /// plane holds.
  ///
  /// Errors, after which the next frame can be written as if this one had not been:
  ///   invalid_argument  options out of bounds, a rate that the format cannot express
  ///   out_of_range      without quantisation, a value beyond +-1860; a viseme outside 0..14, an
  ///                     expression outside 0..6, a blend or an intensity outside 0..63, or values
  ///                     that would be rounded to more than 32 bits; the message names it
  ///   internal          verify failed
  Result<std::vector<std::uint8_t>> write(const fap::Frame& frame, std::uint32_t skip = 0,
                                          const BodyFrame* body = nullptr);
  /// The same into a vector that is used again and again: nothing is allocated once the stream has
  /// run for a while. On errors it is as it was, but for `internal`.
  Result<void> write(const fap::Frame& frame, std::vector<std::uint8_t>& unit,
                     std::uint32_t skip = 0, const BodyFrame* body = nullptr);
  /// The end code, if the stream is to have one, and what is left of the last plane.
  std::vector<std::uint8_t> finish();

  /// What receivers have after the last unit: quantised values, mask = what was coded.
  const fap::Frame& reconstruction() const;
  /// True if the last unit is an intra plane.
  bool intra() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
