// Parses one plane in as many steps as its bytes need to arrive, and applies it once it is
// complete. Not installed API.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec/syntax/arith.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/state_internal.h"
#include "fap/result.h"

namespace animeme::fba::internal {

/// Not a failure, and frequent in live streams: short enough to need no allocation.
inline Error need_more_data() { return make_error(Code::need_data, "needs more data"); }

/// The state of a stream.
struct StreamState {
  SlotState face{face_slots()};
  SlotState body{body_slots()};
  HighLevelState high;
  FaceSettings face_settings;
  BodySettings body_settings;
};

/// One family's part of a parsed plane: symbols of the coded slots in order.
struct ParsedSlots {
  SlotCoding coding;  // intra planes
  std::vector<std::uint16_t> symbols;
};

/// How far the parsing of a plane has come while its bytes are still arriving. What lies before
/// `bit` is final and is not read again.
struct PlaneProgress {
  enum class Stage : std::uint8_t {
    header,
    skip,
    face_masks,
    face_ranges,
    viseme,
    expression,
    face_slots,
    body_masks,
    body_ranges,
    body_slots,
    done,
  };
  Stage stage = Stage::header;
  std::size_t bit = 0;      // where the stage goes on
  std::size_t kind = 0;     // the next set of ranges, by RangeKind
  std::size_t symbols = 0;  // decoded symbols of the segment
  std::optional<SegmentDecoder> segment;
};

/// A plane as read, before it is applied to the state.
struct ParsedPlane {
  bool intra = false;
  ObjectMask object_mask = ObjectMask::nothing;
  TemporalHeader temporal;
  FaceSettings face_settings;
  BodySettings body_settings;
  std::array<std::uint16_t, kHighLevelCount> high_symbols{};
  bool viseme_def = false;
  bool init_face = false;
  bool expression_def = false;
  bool settled = true;  ///< what follows the plane changes nothing in it
  ParsedSlots face{SlotCoding(face_slots()), {}};
  ParsedSlots body{SlotCoding(body_slots()), {}};
  PlaneProgress progress;

  /// A part of the plane has been read, and parse_plane() will go on behind it.
  bool begun() const { return progress.stage != PlaneProgress::Stage::header; }
};

/// Reads a plane at `in`, which is left behind it. Errors: syntax, unsupported, and
///   need_data  the plane, or the look-ahead of its last segment, passes the end of `in`
///              (`last` = false). Call again with a reader of the same bytes and more: the work
///              goes on where it stopped.
///   truncated  the plane passes the end of `in` (`last` = true: nothing follows)
/// Of the state only the models of low-level parameters change, which learn the symbols of
/// predictive planes. After an error other than need_data they are not to be used until the next
/// intra plane.
Result<void> parse_plane(BitReader& in, StreamState& state, bool last, ParsedPlane& plane);

/// Applies a parsed plane: settings, models, reconstruction into `face` (mask and values) and
/// `body` (not null if the plane has a body). Error out_of_range if a value leaves 32 bits; the
/// state is then not to be used until the next intra plane.
Result<void> apply_plane(const ParsedPlane& plane, StreamState& state, fap::Frame& face,
                         BodyFrame* body);

}  // namespace animeme::fba::internal
