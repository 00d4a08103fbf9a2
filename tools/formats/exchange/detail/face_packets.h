// Recorded packets of iFacialMocap and Facemotion3d.
#pragma once

#include <string_view>

#include "fap/result.h"
#include "tools/formats/exchange/detail/shape_table.h"

namespace animeme::exchange {

/// Whether a text begins with a packet: at least three fields between "|", two of which are shapes
/// of ARKit with a number, "mouthSmile_R-0|jawOpen-12|..." or, in version 2, "jawOpen&12".
bool is_face_packets(std::string_view text);

/// Packets as they come over the network (https://www.ifacialmocap.com/for-developer/), one a line,
/// or, as over TCP, one behind the other with "___iFacialMocap" after each. Shapes are percent;
/// "head#" has three angles in degrees about X, Y and Z of ARKit (down, to the person's left, to
/// the right shoulder) and a position, which is left out, "leftEye#" and "rightEye#" have three
/// angles. A number in front of a packet, between blanks, a comma, a tab or "|", is its time;
/// without one the table has no times, and its reader wants a rate.
///
/// Errors, with the line: syntax (a field that is not a number), truncated (a last packet that is
/// cut off is left out with a warning; no whole one is an error).
Result<ShapeTable> face_packets_to_shapes(std::string_view text);

}  // namespace animeme::exchange
