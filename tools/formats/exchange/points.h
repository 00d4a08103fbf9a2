/// @file
/// Tables of captured points: any point with a name, in two or three dimensions.
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
  double start = 0;                   ///< seconds of frame 0, as the file has it
  std::string unit;                   ///< of lengths, as the file names it ("mm"); empty: not told
  std::vector<std::string> warnings;  ///< sentences for people: what was left out or guessed
};

/// How a table is read.
struct PointTableOptions {
  std::optional<fap::Rate> rate;    ///< frames a second; nothing: told from the times
  std::optional<PictureSize> size;  ///< x and y are shares of this picture: they are multiplied
};

/// Most numbers of a recording: frames x points x dimensions.
inline constexpr std::size_t kMostCoordinates = 200'000'000;

/// Reads a table with a header line, fields between commas, semicolons or tabs. Names of columns:
///
///     UL_x, UL_y, UL_z; UL.X; UL:y; lip upper x   a name, a break, x, y or z in any case
///     x61, y61; x_61, X_61                         a number behind it
///     time_s, time, timestamp, timecode; frame; success (0: nothing is seen in this row)
///
/// Other columns are left out. Where numbered points are there both as x and as X (OpenFace), those
/// with X, Y and Z are taken. Points have three dimensions if all have a z. An empty field, nan or
/// inf: the point is not seen. Times and rate are those of read_arkit_table(); without times `rate`
/// has to be given and rows count one after the other. Frames that are missing between rows become
/// frames in which nothing is seen.
///
/// Errors, with line and column: truncated (no rows), syntax (a field that is no number, missing
/// fields, a column that is there twice), not_found (no points; a point without x or y),
/// invalid_argument (no times and no rate; the rate as in read_arkit_table()), out_of_range (times
/// that go back; more than kMostCoordinates, or twenty missing frames for each row).
Result<PointRecording> read_point_table(std::string_view text,
                                        const PointTableOptions& options = {});

}  // namespace animeme::exchange
