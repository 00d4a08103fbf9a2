/// @file
/// The header line of a table of landmarks: which column is which coordinate of which point.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

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
  std::vector<std::string> names;  ///< of all fields
  std::vector<PointFields> points;
  bool depth = false;          ///< all of `points` have z
  bool in_space = false;       ///< x, y, z are those of OpenFace in space, in millimetres
  bool may_be_shares = false;  ///< x and y may be shares of the picture's size (MediaPipe)
  Field time, frame, face, confidence, success;
  Fields3 pose;                     ///< OpenFace: pose_Rx, Ry, Rz
  std::array<Fields3, 2> gaze;      ///< OpenFace: gaze_0 (the person's right eye), gaze_1
  std::array<Field, 2> gaze_angle;  ///< OpenFace: gaze_angle_x, gaze_angle_y
};

/// True for a name that is a coordinate of a landmark or feature point: "x_12", "8.1_x".
bool is_coordinate_name(std::string_view name);
/// True for the name of a point alone: "12", "8.1", "nasion".
bool is_point_name(std::string_view name);
/// True if a header line has coordinates of four landmarks or feature points at least, be they a
/// layout or a part of one.
bool has_landmark_columns(std::string_view header);

/// True if it has any, however few.
bool has_numbered_points(std::string_view header);
/// True if it has a column that is a shape of ARKit.
bool has_shape(std::string_view header);

/// True if a header line names all points of a layout, or four feature points of MPEG-4 at least.
bool is_landmark_header(std::string_view header);

/// Reads the header, see landmarks.h. Other columns are left out; `warnings` names them unless
/// OpenFace or MediaPipe are known to write them.
///
/// Errors, with line and column: not_found (no points; points whose layout cannot be told; points
/// without x or y), syntax (a column that is there twice).
Result<LandmarkColumns> read_landmark_header(const Row& header, const LandmarkTableOptions& options,
                                             std::vector<std::string>& warnings);

}  // namespace animeme::exchange
