// Parses one plane without changing any state, so that it can be tried again when more bytes
// have come, and applies it once it is complete. Not installed API.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/bits.h"
#include "codec/state_internal.h"
#include "fap/result.h"

namespace animeme::fba::internal {

/// The memory of a stream.
struct StreamState {
  SlotState face{face_slots()};
  SlotState body{body_slots()};
  HighLevelState high;
  FaceSettings face_settings;
  BodySettings body_settings;
};

/// One family's part of a parsed plane: symbols of the coded slots in order.
struct ParsedSlots {
  SlotCoding coding;
  std::vector<std::uint32_t> symbols;
};

/// A plane as read, before it is applied to the state.
struct ParsedPlane {
  bool intra = false;
  ObjectMask object_mask = ObjectMask::nothing;
  TemporalHeader temporal;
  FaceSettings face_settings;
  BodySettings body_settings;
  std::array<std::uint32_t, kHighLevelCount> high_symbols{};
  bool viseme_def = false;
  bool init_face = false;
  bool expression_def = false;
  ParsedSlots face{SlotCoding(face_slots()), {}};
  ParsedSlots body{SlotCoding(body_slots()), {}};
};

/// Reads a plane at `in`, which is left behind it. Errors: syntax, unsupported, and
///   need_data  the plane, or the look-ahead of its last segment, passes the end of `in`
///              (`last` = false)
///   truncated  the plane passes the end of `in` (`last` = true: nothing follows)
Result<void> parse_plane(BitReader& in, const StreamState& state, bool last, ParsedPlane& plane);

/// Applies a parsed plane: settings, models, reconstruction into `face` (mask and values) and
/// `body`. Error out_of_range if a value leaves 32 bits; the state is then not to be used until
/// the next intra plane.
Result<void> apply_plane(const ParsedPlane& plane, StreamState& state, fap::Frame& face,
                         BodyFrame& body);

}  // namespace animeme::fba::internal
