/// @file
/// What stands at the begin of an access unit: kind of plane, rate and skipped frames, without
/// decoding it. Source: codec/bitstream.md, sections 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/syntax/plane.h"

namespace animeme::fba {

/// What a plane says of itself before its settings.
struct PlaneHeader {
  bool intra = false;                            ///< nothing before it is needed to decode it
  ObjectMask object_mask = ObjectMask::nothing;  ///< what it codes
  TemporalHeader temporal;                       ///< rate and time code in intra planes only
};

/// Reads the header of the plane in an access unit (AccessUnit::bytes; old start codes will do).
/// nullopt: no plane start code behind the optional object start code, a header that is cut off or
/// not legal.
std::optional<PlaneHeader> read_plane_header(std::span<const std::uint8_t> unit);

}  // namespace animeme::fba
