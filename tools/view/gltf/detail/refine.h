// Textures on meshes that show colours of vertices only: triangles are divided where the texture
// changes.
#pragma once

#include <vector>

#include "tools/view/gltf/detail/primitive.h"

namespace animeme::gltf {

/// Divides triangles of the face, worst edges first, until the pieces have `vertices` vertices or
/// straight lines between the colours of vertices are near enough to the texture. The face is the
/// box around all that shapes move; without shapes, everything. New vertices lie in the middle of
/// edges, and move half as each end does; so the surface stays as it is. Cracks do not open: an
/// edge is divided in all triangles that share it, also across seams.
void refine(std::vector<RawPiece>& pieces, std::size_t vertices);

}  // namespace animeme::gltf
