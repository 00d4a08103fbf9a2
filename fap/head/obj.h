/// @file
/// Wavefront OBJ: the meshes of a head, as every 3D package writes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/head/own_head.h"
#include "fap/result.h"

namespace animeme::head {

/// A file of meshes, sorted by the parts of a head.
struct ObjFile {
  /// A piece for each part that the names of objects, groups and materials tell (part_by_name()),
  /// with the names of its first group, so that vertices that parts share stay connected. Meshes
  /// that should not be shown are left out. Colours are those of the vertices ("v x y z r g b",
  /// linear, 0..1) if all have them, else colour_by_name().
  std::vector<Piece> pieces;
  /// Where a vertex of the file went.
  struct Place {
    std::size_t piece = 0;            ///< index of `pieces`
    std::uint32_t vertex = kMissing;  ///< index within the piece
  };
  /// For each vertex of the file, counted from 0: its place. Not in any shown face: missing.
  std::vector<Place> vertices;
};

/// Reads v, f, o, g, usemtl; all else (texture places, normals, curves) is passed over. Polygons
/// are cut into triangles around their first corner. Negative vertex numbers count from the end.
/// Errors: syntax with line:column (a number that is none, a face with less than three
/// corners or with a vertex that does not exist yet), out_of_range (more than 500000 vertices or
/// 2 million triangles), invalid_argument if there is no face.
Result<ObjFile> read_obj(std::string_view text);

/// Writes a head at rest: a group for each part with the part's name, colours at the vertices,
/// lengths in cm with six digits. read_obj() and assemble() give the same head back, lashes
/// included, with points_of() as its list.
std::string write_obj(const Head& head);

/// The feature points of a head as a list for the vertices of write_obj().
std::string points_of(const Head& head);

}  // namespace animeme::head
