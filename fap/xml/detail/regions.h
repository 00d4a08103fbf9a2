// Raised cosines that come near to given moves.
#pragma once

#include "fap/xml/detail/xface.h"

namespace animeme::head::detail {

/// A mesh as the fitting of regions sees it.
struct RegionMesh {
  std::span<const Vec3> positions;
  std::array<std::uint32_t, 3> lowest;  ///< vertices at the ends of X, Y and Z
  std::array<std::uint32_t, 3> highest;
};
RegionMesh region_mesh(std::span<const Vec3> positions);

/// A vertex and how far it should go with a FAP: 1 is as far as its feature point.
struct Wanted {
  std::uint32_t vertex = 0;
  float factor = 0;
};

struct RegionTask {
  int fap = 0;
  std::uint32_t pivot = 0;     ///< the vertex of the feature point, or the one nearest to it
  bool exact_at_pivot = true;  ///< the pivot moves as wanted, whatever the others do
  int most = 12;               ///< regions
  std::vector<Wanted> wanted;  ///< by vertex, ascending
};

/// Regions whose factors come near to those wanted: one wide cosine around the pivot, with a vertex
/// in it that is far away and sets its width, cut into bands of vertices that like the same weight.
std::vector<XfaceItem> fit_regions(const RegionMesh& mesh, const RegionTask& task);

/// The same for small parts that move as a whole, where no vertex is far away: two waves from both
/// ends of the mesh, which add up to the same everywhere. Takes two slots of each vertex.
std::vector<XfaceItem> fit_waves(const RegionMesh& mesh, const RegionTask& task);

}  // namespace animeme::head::detail
