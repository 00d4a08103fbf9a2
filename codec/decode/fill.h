/// @file
/// From a decoded stream to complete frames: what a receiver shows.
#pragma once

#include "codec/decode/decoder.h"
#include "codec/syntax/plane.h"
#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// What the mask types of an intra plane say about the FAPs that are not coded, in the terms of
/// fap/fill.h: types none, hold and all are GroupRule::hold (with all, nothing is left to hold),
/// interpolate is GroupRule::interpolate. Source: codec/bitstream.md, sections 3.1 and 9.
fap::GroupRules group_rules(const FaceSettings& settings);

/// The face of a decoded stream with every FAP resolved: face_sequence() through fap::fill() with
/// the rules of each plane. Where a text file leaves open what absent FAPs do, the stream says it:
///
/// - types 0 and 1: a FAP that is not coded keeps the value it shows, neutral at first. It does
///   not follow its other side, however often that is coded;
/// - type 2: it follows what this plane codes: other side, else other lip contour, else the other
///   side of that. If an intra plane takes the source away, the last value stays.
///
/// Coded values are never changed. The result has the frame numbers 0, 1, 2 ..., one mask, and
/// FAP 1 and 2 as fap::FillOptions say; `prefer_partner` has no effect. A stream without a face
/// gives a clip without frames.
///
/// Errors: those of fap::fill(); of a stream from decode() only out_of_range can occur, if
/// skipped frames make it longer than max_frames.
Result<fap::Sequence> fill(const DecodedStream& stream, const fap::FillOptions& options = {});

}  // namespace animeme::fba
