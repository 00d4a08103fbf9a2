// Writes the headers of a plane, before its segments. Not installed API. Source:
// codec/bitstream.md, sections 2, 3 and 7.
#pragma once

#include "codec/syntax/bits.h"
#include "codec/syntax/plane.h"

namespace animeme::fba::internal {

/// Temporal header; rate and time code only if `intra`.
void write_temporal(BitWriter& out, bool intra, const TemporalHeader& temporal);

/// Quantiser, masks, gender, coding type and ranges of an intra plane.
void write_face_settings(BitWriter& out, const FaceSettings& settings);
void write_body_settings(BitWriter& out, const BodySettings& settings);

}  // namespace animeme::fba::internal
