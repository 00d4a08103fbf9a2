// Which triangles hang together, and which of them agree about where the outside is.
#pragma once

#include "fap/head/model.h"

namespace animeme::head::detail {

inline constexpr std::uint32_t kNobody = ~0u;

/// The body that a triangle is of.
struct SidedTriangle {
  std::uint32_t body = kNobody;  ///< from 0; kNobody: it has no side of its own
  bool other = false;  ///< it disagrees with the first triangle of the body about the outside
};

/// For each triangle of a mesh its body. Triangles hang together at an edge that two of them have,
/// by their vertices or, at the borders of a mesh that exporters cut where normals or textures
/// change, by their places; where three and more meet nobody knows which two belong together. Those
/// without area and those that are there twice, from both sides, have no side.
std::vector<SidedTriangle> sided_bodies(const Mesh& mesh);

}  // namespace animeme::head::detail
