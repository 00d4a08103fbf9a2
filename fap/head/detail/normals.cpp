#include "fap/head/detail/normals.h"

#include <utility>

#include "fap/head/detail/geodesic.h"

namespace animeme::head::detail {

void smooth_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                    std::vector<Vec3>& normals) {
  normals.assign(positions.size(), Vec3{});
  for (const Triangle& t : triangles) {
    const Vec3 a = positions[t[0]];
    const Vec3 n = cross(positions[t[1]] - a, positions[t[2]] - a);
    normals[t[0]] += n;
    normals[t[1]] += n;
    normals[t[2]] += n;
  }
  for (Vec3& n : normals) n = normalised(n);
}

std::vector<Vec3> broad_normals(std::vector<Vec3> normals, std::span<const Triangle> triangles) {
  constexpr int kRounds = 16;
  const Neighbours neighbours = neighbours_of(normals.size(), triangles);
  std::vector<Vec3> next(normals.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
      Vec3 sum = normals[v];
      for (const std::uint32_t n : neighbours.of(std::uint32_t(v))) sum += normals[n];
      next[v] = normalised(sum);
    }
    std::swap(normals, next);
  }
  return normals;
}

}  // namespace animeme::head::detail
