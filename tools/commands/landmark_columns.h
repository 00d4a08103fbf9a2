/// @file
/// The header line of a table of landmarks: which column is which coordinate of which point.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/table_text_internal.h"
#include "fap/landmarks.h"
#include "fap/result.h"

namespace animeme::tools {

/// Places among the fields of a row.
using Field = std::optional<std::size_t>;
using Fields3 = std::array<Field, 3>;  ///< x, y, z

/// A feature point, as the mean of one or two landmarks.
struct PointFields {
  std::string point;               ///< id, see fap/landmarks.h
  std::vector<Fields3> landmarks;  ///< whose mean it is, one or two
};

/// Which column is what.
struct LandmarkColumns {
  char separator = ',';             ///< comma, semicolon or tab
  std::vector<std::string> names;   ///< of all fields
  std::vector<PointFields> points;  ///< found in the header
  bool depth = false;               ///< all of `points` have z
  bool may_be_shares = false;       ///< x and y may be shares of the picture's size (MediaPipe)
  Field time,                       ///< s or a timecode
      frame,                        ///< of the recording
      face,                         ///< face_id
      confidence,                   ///< 0..1
      success;                      ///< 0 or 1
  Fields3 pose;                     ///< OpenFace: pose_Rx, Ry, Rz
  std::array<Fields3, 2> gaze;      ///< OpenFace: gaze_0 (the person's right eye), gaze_1
  std::array<Field, 2> gaze_angle;  ///< OpenFace: gaze_angle_x, gaze_angle_y
};

/// What the user says of the columns.
struct LandmarkColumnOptions {
  std::optional<fap::LandmarkLayout> layout;  ///< nothing: told by the number of points
  bool flat = false;                          ///< leave out what is known of depth
};

/// True if a header line names all points of a layout, or four feature points of MPEG-4 at least.
bool is_landmark_header(std::string_view header);

/// Reads the header. Names of columns, in any case but for X and x where there are both:
///
///     x_0, y_0, x0, X_0 ... z_67       OpenFace; where both are there X, Y, Z are the points in
///                                      space and x, y those of the picture, which count if `flat`
///     landmark_0_x, lm0_x, p0x, 0_x    and the like
///     8.1_x, fp8.1_x, nasion_x         feature points of MPEG-4
///
/// and those of LandmarkColumns. Other columns are left out; `warnings` names them unless OpenFace
/// or MediaPipe are known to write them. Numbers count from 0, or from 1 if there is no 0.
///
/// Errors, with line and column: not_found (no points; points whose layout cannot be told; points
/// without x or y), syntax (a column that is there twice).
Result<LandmarkColumns> read_landmark_header(const dam::TableLine& line,
                                             const LandmarkColumnOptions& options,
                                             std::vector<std::string>& warnings);

}  // namespace animeme::tools
