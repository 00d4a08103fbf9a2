// Closed meshes of distance fields ("naive surface nets": a vertex in each cell of a grid that the
// surface crosses, a quad for each crossed edge).
#pragma once

#include <functional>

#include "fap/head/model.h"

namespace animeme::head::detail {

using Field = std::function<double(Vec3d)>;

/// The surface inside of the box low..high, which it must not leave. Vertices are then put on the
/// surface. Colours and occlusion are left empty.
Mesh surface_nets(const Field& field, Vec3d low, Vec3d high, double cell);

/// Appends `other` to `mesh`.
void append(Mesh& mesh, const Mesh& other);

/// Appends the mirror image (x becomes -x) of the vertices and triangles from these on.
void append_mirrored(Mesh& mesh, std::size_t first_vertex, std::size_t first_triangle);

}  // namespace animeme::head::detail
