#include "fap/head/detail/normals.h"

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

}  // namespace animeme::head::detail
