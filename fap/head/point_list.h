/// @file
/// Lists of landmarks: the vertex of a mesh for each feature point.
///
///     feature_point,vertex          2.1 966            feature_point,x,y,z
///     2.1,966                       8.3 6213           2.1,0.0,-7.57,10.43
///     8.3,6213                      # left corner      8.3,2.53,-3.52,10.19
///
/// The left form has a heading and may have further columns, the middle one has none. Vertices
/// count from 0 in the order of the file, as in Blender. Positions are in the axes and units of the
/// file: the nearest vertex is used.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/head/obj.h"
#include "fap/head/own_head.h"
#include "fap/result.h"

namespace animeme::head {

/// One line of a list: a feature point and its vertex or position.
struct PointRow {
  std::string id;                       ///< "2.1"; not checked
  std::string mesh;                     ///< name of the object it is on; empty: any
  std::optional<std::uint32_t> vertex;  ///< nullopt: given by position
  std::optional<Vec3> place;            ///< nullopt: given by vertex
  std::int64_t line = 0;                ///< of the text, from 1
};

/// Reads a list: comma, semicolon, tab or spaces between fields; # begins a comment. Headings, in
/// any case: a column whose name has "point" or is "id"; one whose name has "vertex" or "index";
/// "mesh" or "object"; and those that begin with x, y and z. Errors: syntax with line (an invalid
/// number, a row with neither vertex nor position), out_of_range (more than 10000 rows),
/// invalid_argument if there is no row.
/// out_of_range (more than 10000 rows), invalid_argument if no row is there.
Result<std::vector<PointRow>> read_points(std::string_view text);

/// The points on the pieces of an OBJ file. Errors: not_found with the line if a vertex does not
/// exist or is in no visible face.
Result<std::vector<PiecePoint>> points_on(const ObjFile& file, const std::vector<PointRow>& rows);

/// The points on the pieces of any file: vertices count through all pieces named `mesh`, or through
/// the first piece of skin if no name is given. Errors: not_found with the line.
Result<std::vector<PiecePoint>> points_on(const std::vector<Piece>& pieces,
                                          const std::vector<PointRow>& rows);

}  // namespace animeme::head
