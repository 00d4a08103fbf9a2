/// @file
/// Wavefront OBJ: reads and writes the meshes of a head.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/head/own_head.h"
#include "fap/result.h"

namespace animeme::head {

/// The meshes of a file, sorted by the parts of a head.
struct ObjFile {
  /// A piece for each part identified by the names of objects, groups and materials
  /// (part_by_name()), with the names of its first group, so that vertices shared by parts stay
  /// connected. Meshes that should not be shown are omitted. Colours are those of the vertices ("v
  /// x y z r g b", linear, 0..1) if all have them, else colour_by_name().
  std::vector<Piece> pieces;
  /// New position of a vertex of the file.
  struct Place {
    std::size_t piece = 0;            ///< index of `pieces`
    std::uint32_t vertex = kMissing;  ///< index within the piece
  };
  /// For each vertex of the file, counted from 0. kMissing: in no visible face.
  std::vector<Place> vertices;
};

/// Reads v, f, o, g, usemtl; everything else (texture coordinates, normals, curves) is skipped.
/// Polygons are triangulated as fans around their first corner. Negative vertex numbers count from
/// the end. Errors: syntax with line:column (an invalid number, a face with less than three corners
/// or with a vertex that does not exist yet), out_of_range (more than 500000 vertices or 2 million
/// triangles), invalid_argument if there is no face.
Result<ObjFile> read_obj(std::string_view text);

/// Writes a head at rest: a group for each part with the part's name, vertex colours, lengths in cm
/// with six digits. read_obj() and assemble() restore the same head, including lashes, with
/// points_of() as its list.
std::string write_obj(const Head& head);

/// The feature points of a head as a list for the vertices of write_obj().
std::string points_of(const Head& head);

}  // namespace animeme::head
