/// @file
/// Tables of tracked landmarks of a face: OpenFace, dlib, MediaPipe, feature points.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/landmarks.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/commands/landmark_columns.h"
#include "tools/commands/landmark_rows.h"

namespace animeme::tools {

/// Of the video that was tracked.
struct PictureSize {
  double width = 0;   ///< pixels
  double height = 0;  ///< pixels
};

/// What the user says of a table.
struct LandmarkCsvOptions {
  std::optional<fap::Rate> rate;    ///< nothing: told from the times
  LandmarkColumnOptions columns;    ///< see landmark_columns.h
  std::optional<PictureSize> size;  ///< of the picture whose shares x and y are, see below
  LandmarkRowOptions rows;          ///< see landmark_rows.h
};

/// True if read_landmark_csv() is for a text, by its first line.
bool is_landmark_csv(std::string_view text);

/// Reads a table with a header line, fields between commas, semicolons or tabs; for the names of
/// columns see landmark_columns.h.
///
/// - Times and the rate are those of read_arkit_csv(). Without times, or if all are equal (OpenFace
///   on pictures), `rate` has to be given: rows count by `frame`, or one after the other.
/// - Rows with success 0, a confidence below the limit or of another face are left out and become
///   skipped frames; a coordinate that is empty or nan is a point that was not seen.
/// - x and y of MediaPipe are shares of the picture's width and height if all lie between -0.5 and
///   1.5 (z has the unit of x). `size` says how wide and high it is; without it, the one of 16:9,
///   4:3, 1:1, 3:4 and 9:16 is taken that gives a face of usual proportions (between the outer
///   corners of the eyes it is 1.9 times as wide as from there to the base of the nose: mean of two
///   head models), an estimate that `warnings` tells.
/// - OpenFace: axes of the camera are x right, y down, z away, so FAP 48 is pose_Rx, and Ry and Rz
///   change their sign; gaze_0 is the eye on the left of the picture, the person's right one.
///
/// Errors, with line and column: truncated (no rows), syntax (a field that is no number, missing
/// fields), invalid_argument (no times and no rate), not_found (no such face), and those of
/// read_landmark_header() and place_rows().
Result<fap::LandmarkTrack> read_landmark_csv(std::string_view text,
                                             const LandmarkCsvOptions& options,
                                             std::vector<std::string>& warnings);

}  // namespace animeme::tools
