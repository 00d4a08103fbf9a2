/// @file
/// Tables of captured points with arbitrary names, in two or three dimensions.
///
///     auto take = animeme::exchange::read_point_table(text);
///     if (take) use(take->track, take->warnings);
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/crossmap/points.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

/// A recording of points, from a table or a C3D file.
struct PointRecording {
  dam::PointTrack track;              ///< without a name; frame 0 is the first
  double start = 0;                   ///< seconds of frame 0 in the file
  std::string unit;                   ///< of lengths, as named by the file ("mm"); empty: unknown
  std::vector<std::string> warnings;  ///< sentences for the user: what was dropped or guessed
};

/// Options for reading a table.
struct PointTableOptions {
  std::optional<fap::Rate> rate;    ///< frames a second; nullopt: from the times
  std::optional<PictureSize> size;  ///< x and y are fractions of this size and are multiplied by it
};

/// Maximum size of a recording: frames x points x dimensions.
inline constexpr std::size_t kMostCoordinates = 200'000'000;

/// Reads a table with a header line, fields separated by commas, semicolons or tabs. Column names:
///
///     UL_x, UL_y, UL_z; UL.X; UL:y; lip upper x   a name, a separator, x, y or z in any case
///     x61, y61; x_61, X_61                         a number after it
///     time_s, time, timestamp, timecode; frame; success (0: all points of this row are missing)
///
/// Other columns are ignored. If numbered points exist both as x and as X (OpenFace), X, Y and Z
/// are used. Points have three dimensions if all have a z. An empty field, nan or inf: the point is
/// missing. Times and rate are those of read_arkit_table(); without times `rate` is required and
/// rows are consecutive. Missing rows become frames without points.
///
/// Errors, with line and column: truncated (no rows), syntax (a field that is not a number, missing
/// fields, a duplicate column), not_found (no points; a point without x or y), invalid_argument (no
/// times and no rate; the rate as in read_arkit_table()), out_of_range (times that go back; more
/// than kMostCoordinates, or twenty missing frames for each row).
Result<PointRecording> read_point_table(std::string_view text,
                                        const PointTableOptions& options = {});

}  // namespace animeme::exchange
