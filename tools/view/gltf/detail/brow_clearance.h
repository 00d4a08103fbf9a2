// Brows that are a mesh upon the skin, as those of VRoid: shapes that let the skin hide them are
// changed so that they stay in front of it.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/view/gltf/detail/face_shapes.h"

namespace animeme::gltf {

/// Moves vertices of brows forwards (+Z), in each shape as far as is wanted so that what lies up to
/// a tenth of `eye_distance` in front of the skin at rest does so, too, with the shape at weight 1:
/// as far as at rest, or a fiftieth of `eye_distance`. Shapes add up, so their sums keep clear as
/// well. Pieces are welded and look along +Z. Gives the number of shapes that had
/// hidden more than a twentieth of a mesh.
std::size_t keep_brows_in_front(std::vector<RawPiece>& pieces, const FaceShapes& face,
                                float eye_distance);

}  // namespace animeme::gltf
