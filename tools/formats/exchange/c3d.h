/// @file
/// Markers from C3D, the file format of motion capture systems (Vicon, Qualisys, OptiTrack, Motion
/// Analysis).
///
///     if (is_c3d(bytes)) { auto take = animeme::exchange::read_c3d(bytes); ... }
///
/// Source: "The C3D File Format: User Guide" (Motion Lab Systems). Debian 12 has no library for it.
#pragma once

#include <cstdint>
#include <span>

#include "fap/result.h"
#include "tools/formats/exchange/points.h"

namespace animeme::exchange {

/// Recognised by the second byte of the header, 0x50, and the number of its first parameter block.
bool is_c3d(std::span<const std::uint8_t> bytes);

/// Reads the markers: numbers in Intel, DEC or MIPS format, coordinates as integers times
/// POINT:SCALE or as floating point (a negative scale). A marker with a negative residual is
/// missing. Names are POINT:LABELS, LABELS2 ... without surrounding blanks; a marker without a name
/// is "M7", counted from 1, and a duplicate name gets "_2". Rate: POINT:RATE, or that of the
/// header. Unit: POINT:UNITS. Analogue channels, events and everything else are ignored.
///
/// If a file ends before its last frame, the complete frames are returned, with a warning. Errors,
/// with the bit: syntax (not C3D; inconsistent parameters; an invalid rate), truncated (ends in its
/// header or parameters, or before its first frame), not_found (no markers), out_of_range (more
/// than kMostCoordinates).
Result<PointRecording> read_c3d(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
