// Normals of a mesh.
#pragma once

#include <span>
#include <vector>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// Mean normal of the triangles around each vertex, by area; length 1.
void smooth_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                    std::vector<Vec3>& normals);

}  // namespace animeme::head::detail
