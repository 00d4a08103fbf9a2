// Which vertices of a piece are one: at seams of a texture files have them twice.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/view/gltf/detail/primitive.h"

namespace animeme::gltf {

/// For each vertex the first one with the same place, the same moves in all shapes and the same
/// share of the neck, to the bit. Upper and lower lip, which move apart, are never one.
std::vector<std::uint32_t> first_alike(const RawPiece& piece);

/// Joins vertices that are alike; colours become their mean, uvs are lost, corners stay as
/// many and move along with what their vertex has become. Vertices without a triangle go.
/// Triangles that have become lines go.
void weld(RawPiece& piece);

}  // namespace animeme::gltf
