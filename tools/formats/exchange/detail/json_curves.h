// Curves of ARKit shapes in JSON of any structure.
#pragma once

#include <optional>
#include <string_view>

#include "tools/formats/common/json.h"
#include "tools/formats/exchange/detail/shape_table.h"

namespace animeme::exchange {

/// Finds names, frames and rate by their shape, not by the names of members:
///
/// - a list of names (at least two of them ARKit's) beside a matrix of numbers, one row a frame or
///   one a name, or beside frames that each hold a row (animeme-arkit, Audio2Face, BEAT);
/// - a list of objects, or of lists of {name, number}, that each hold numbers by name, at any depth
///   (MediaPipe, face-api, dictionaries); an object of such objects by number; one frame alone;
/// - an object with a list of numbers a name, or with a curve in another form (json_series.h);
/// - pieces of 55 numbers a frame and the number of their first frame (Azure Speech, 60 a second),
///   also as text in `animation` of its viseme events.
///
/// The rate is a number, or two, called fps, frameRate, exportFps, rate or the like, beside the
/// frames or further out, or the seconds of a frame: dt, frameTime; the time of a frame time,
/// timestamp, t, timeCode and the like in seconds, as a number or a text, or timestamp_ms, time_ms.
/// With neither, the table has no times, and its reader wants a rate. Frames are sorted by time. A
/// null is a missing number.
///
/// nullopt: there are no such curves.
std::optional<ShapeTable> find_json_curves(const tools::Json& root);

/// Whether the beginning of a text is JSON that has two names of ARKit's shapes, or Azure's
/// BlendShapes: it may be cut off.
bool looks_like_json_curves(std::string_view text);

}  // namespace animeme::exchange
