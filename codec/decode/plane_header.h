/// @file
/// The header of an access unit (kind of plane, rate and skipped frames), without decoding it.
/// Source: codec/bitstream.md, sections 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/syntax/plane.h"

namespace animeme::fba {

/// The fields of a plane before its settings.
struct PlaneHeader {
  bool intra = false;                            ///< decodable without any earlier plane
  ObjectMask object_mask = ObjectMask::nothing;  ///< what is coded
  TemporalHeader temporal;                       ///< rate and time code in intra planes only
};

/// Reads the header of the plane in an access unit (AccessUnit::bytes; old start codes are
/// accepted). nullopt: no plane start code behind the optional object start code, a truncated or
/// invalid header.
std::optional<PlaneHeader> read_plane_header(std::span<const std::uint8_t> unit);

}  // namespace animeme::fba
