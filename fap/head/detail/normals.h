// Normals of a mesh.
#pragma once

#include <span>
#include <vector>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// Mean normal of the triangles around each vertex, by area; length 1.
void smooth_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                    std::vector<Vec3>& normals);

/// The same averaged over larger and larger surroundings, so that creases are gone.
std::vector<Vec3> broad_normals(std::vector<Vec3> normals, std::span<const Triangle> triangles);

}  // namespace animeme::head::detail
