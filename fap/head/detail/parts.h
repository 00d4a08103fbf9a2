// The parts of a head besides its skin.
#pragma once

#include "fap/head/detail/grid.h"
#include "fap/head/detail/surface_nets.h"

namespace animeme::head::detail {

Mesh make_eye(const Shape& shape, int side);    ///< 1: left, -1: right
double ear_field(const Shape& shape, Vec3d p);  ///< distance to the left ear
Mesh make_left_ear(const Shape& shape);         ///< closed, a part of the skin
/// Edges of the hair above the face, on the skin.
struct HairLines {
  std::vector<Vec3d> left, right;
};
bool hangs(HairStyle style);  ///< it is a bob, or longer
HairLines hair_lines(const Shape& shape);
double hair_field(const Shape& shape, const HairLines& lines, Vec3d p);  ///< distance to the hair
Mesh make_hair(const Shape& shape);
double short_hair_field(const Shape& shape, Vec3d p);  ///< the cap alone, without its locks
Mesh make_short_hair(const Shape& shape);
void add_glasses(const Shape& shape, Mesh& mesh);  ///< to the hair, if there are any
double body_field(const Shape& shape, Vec3d p);
Mesh make_body(const Shape& shape);
Mesh make_teeth(const Shape& shape, bool upper);  ///< with gums
Mesh make_tongue(const Shape& shape);
/// Vertices of the tongue: rows from the root to the tip, around each row from the top, then one
/// in the tip.
inline constexpr int kTongueRows = 16;
inline constexpr int kTongueAround = 16;
/// Left, then right; hairs of a beard are among them, as they move with the skin, too.
Mesh make_brows(const Shape& shape);
/// Left, then right. `anchors` gets the vertex of the rim that carries each vertex.
Mesh make_lashes(const Shape& shape, const Skin& skin, std::vector<std::uint32_t>& anchors);

}  // namespace animeme::head::detail
