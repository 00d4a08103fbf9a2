/// @file
/// C3D, the file of motion capture systems (Vicon, Qualisys, OptiTrack, Motion Analysis): markers.
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

/// Told by the second byte of the header, 0x50, and the number of its first parameter block.
bool is_c3d(std::span<const std::uint8_t> bytes);

/// Reads the markers: numbers as Intel, DEC or MIPS processors write them, places as whole numbers
/// times POINT:SCALE or as floating point (a negative scale). A marker with a negative residual is
/// not seen. Names are POINT:LABELS, LABELS2 ... without blanks at their ends; a marker without one
/// is "M7", counted from 1, and a name that is there already gets "_2". Rate: POINT:RATE, else that
/// of the header. Unit: POINT:UNITS. Analogue channels, events and all else are passed over.
///
/// A file that ends before its last frame gives those that are whole, with a warning.
/// Errors, with the bit: syntax (no C3D; parameters that do not hold together; a rate that is
/// none), truncated (it ends in its header or parameters, or before its first frame), not_found (no
/// markers), out_of_range (more than kMostCoordinates).
Result<PointRecording> read_c3d(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
