// Triangles of lists, strips and fans.
#pragma once

#include <cstdint>
#include <vector>

#include "fap/head/model.h"
#include "fap/result.h"

namespace animeme::gltf {

inline constexpr std::size_t kTriangles = 4;
inline constexpr std::size_t kTriangleStrip = 5;
inline constexpr std::size_t kTriangleFan = 6;

/// Without those that have no area because two corners are one. Error: syntax (an index beyond the
/// vertices).
inline Result<std::vector<head::Triangle>> triangles_of(const std::vector<std::uint32_t>& indices,
                                                        std::size_t vertices, std::size_t mode) {
  std::vector<head::Triangle> triangles;
  for (const std::uint32_t index : indices) {
    if (index >= vertices) {
      return make_error(Code::syntax,
                        "a triangle has a vertex that does not exist: export the file again");
    }
  }
  const std::size_t step = mode == kTriangles ? 3 : 1;
  for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
    head::Triangle t = {indices[i], indices[i + 1], indices[i + 2]};
    if (mode == kTriangleStrip && i % 2 == 1) std::swap(t[1], t[2]);
    if (mode == kTriangleFan) t = {indices[0], indices[i + 1], indices[i + 2]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace animeme::gltf
