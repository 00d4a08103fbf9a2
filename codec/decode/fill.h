/// @file
/// Completes the frames of a decoded stream, as a receiver does.
#pragma once

#include "codec/decode/decoder.h"
#include "codec/syntax/plane.h"
#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// The rules of an intra plane's mask types for FAPs that are not coded, in the terms of
/// fap/fill.h: types none, hold and all are GroupRule::hold (with all, nothing is left to hold),
/// interpolate is GroupRule::interpolate. Source: codec/bitstream.md, sections 3.1 and 9.
fap::GroupRules group_rules(const FaceSettings& settings);

/// The face of a decoded stream with every FAP resolved: face_sequence() through fap::fill() with
/// the rules of each plane. Unlike a text file, a stream defines the value of absent FAPs:
///
/// - types 0 and 1: a FAP that is not coded keeps the value it shows, initially neutral. It does
///   not follow its other side, however often that is coded;
/// - type 2: it follows the FAPs of this plane: its other side, else its other lip contour, else
///   the other side of that. If an intra plane removes the source, the last value stays.
///
/// Coded values are never changed. The result has the frame numbers 0, 1, 2 ..., one mask, and FAP
/// 1 and 2 according to fap::FillOptions; `prefer_partner` has no effect. A stream without a face
/// gives a clip without frames.
///
/// Errors: those of fap::fill(); for a stream from decode() only out_of_range can occur, if skipped
/// frames make it longer than max_frames.
Result<fap::Sequence> fill(const DecodedStream& stream, const fap::FillOptions& options = {});

}  // namespace animeme::fba
