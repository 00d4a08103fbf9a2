// Distances on a mesh along its edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// Neighbours of each vertex, ascending: those of v are ids[first[v]] .. ids[first[v + 1] - 1].
struct Neighbours {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> ids;

  std::span<const std::uint32_t> of(std::size_t v) const {
    return std::span(ids).subspan(first[v], first[v + 1] - first[v]);
  }
};
Neighbours neighbours_of(std::size_t vertices, std::span<const Triangle> triangles);

struct Reached {
  std::uint32_t vertex;
  float distance;
};

/// All vertices within `reach` of the nearest of `starts`, nearest first, with the length of the
/// shortest way along edges. Equal distances: the lower vertex first.
std::vector<Reached> walk(std::span<const Vec3> positions, const Neighbours& neighbours,
                          std::span<const std::uint32_t> starts, float reach);
inline std::vector<Reached> walk(std::span<const Vec3> positions, const Neighbours& neighbours,
                                 std::uint32_t start, float reach) {
  return walk(positions, neighbours, std::span(&start, 1), reach);
}

}  // namespace animeme::head::detail
