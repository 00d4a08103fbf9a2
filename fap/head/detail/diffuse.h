// Values on a mesh that run into each other.
#pragma once

#include "fap/head/detail/weights.h"

namespace animeme::head::detail {

/// One implicit step of heat flow for each column of a table: values run into each other over
/// about radii[v] cm around vertex v, however dense the mesh is there. By conjugate gradients with
/// sums in a fixed order.
void diffuse(std::span<const Vec3> positions, const Neighbours& neighbours,
             std::span<const float> radii, Weights& table);

}  // namespace animeme::head::detail
