#include "fap/head/detail/slide.h"

#include <array>
#include <utility>

#include "fap/head/detail/diffuse.h"
#include "fap/head/detail/normals.h"

namespace animeme::head::detail {
namespace {

constexpr float kSteepest = 1.5f;  // of a forehead on which brows slide
constexpr float kBroad = 1.2f;     // cm on a face with ES 6.3: normals are means over about this

// Creases and the line between left and right do not count.
std::vector<Vec3> broad(const Head& head, const std::vector<Vec3>& normals) {
  const Mesh& skin = head.part(Part::skin);
  Weights table(normals.size(), 3);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec3 n = normals[v];
    std::copy_n(std::array{n.x, n.y, n.z}.begin(), 3, table.row(v).begin());
  }
  const std::vector<float> radii(normals.size(), kBroad * float(head.fapu.es) / 6.3f);
  diffuse(skin.positions, neighbours_of(normals.size(), skin.triangles), radii, table);
  std::vector<Vec3> means;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const auto n = std::as_const(table).row(v);
    means.push_back(normalised(Vec3{n[0], n[1], n[2]}));
  }
  return means;
}

}  // namespace

Slide::Slide(const Head& head) : head_(head) {
  const Mesh& skin = head.part(Part::skin);
  smooth_normals(skin.positions, skin.triangles, normals_);
  broad_normals_ = broad(head, normals_);
}

void Slide::on_bone(std::vector<Vec3>& deltas) const {
  for (std::size_t v = 0; v < deltas.size(); ++v) {
    const Vec3 n = broad_normals_[v];
    if (n.z > 0 && n.y > 0) deltas[v].z -= deltas[v].y * std::min(n.y / n.z, kSteepest);
  }
}

void Slide::below_hair(std::vector<Vec3>& deltas) const {
  const auto& freedom = head_.seams.freedom;
  for (std::size_t v = 0; v < freedom.size() && v < deltas.size(); ++v) {
    deltas[v] -= normals_[v] * (dot(normals_[v], deltas[v]) * (1 - freedom[v]));
  }
}

}  // namespace animeme::head::detail
