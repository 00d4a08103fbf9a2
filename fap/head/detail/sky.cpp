#include "fap/head/detail/own_steps.h"

#include <limits>

#include "fap/head/detail/look.h"
#include "fap/head/detail/normals.h"

namespace animeme::head::detail {
namespace {

constexpr int kSides = 64;
constexpr int kSize = 256;  // pixels of a depth picture
constexpr float kLeastLight = 0.04f;
// Teeth and tongue are in the dark while the mouth is shut, but who sees them has opened it.
constexpr float kTeethLight = 0.7f;
constexpr float kTongueLight = 0.55f;
constexpr float kOwn = 0.12f;  // cm: a surface does not hide itself

// A depth picture of all parts: the sky is as far away as anything can be.
class Depths {
 public:
  Depths(const Head& head, Vec3 from, float radius)
      : look_(from, radius, kSize), depths_(std::size_t(kSize) * kSize, kSky) {
    for (const Mesh& mesh : head.parts) {
      const std::vector<Vec3> places = look_.places(mesh.positions);
      for (const Triangle& t : mesh.triangles) {
        look_.draw(places[t[0]], places[t[1]], places[t[2]],
                   [&](std::size_t i, float z) { depths_[i] = std::max(depths_[i], z); });
      }
    }
  }

  bool sees(Vec3 p) const {
    const Vec3 q = look_.place(p);
    const int x = int(q.x);
    const int y = int(q.y);
    if (x < 0 || y < 0 || x >= kSize || y >= kSize) return true;
    return q.z + kOwn >= depths_[std::size_t(y) * kSize + std::size_t(x)];
  }

 private:
  static constexpr float kSky = std::numeric_limits<float>::lowest();

  Look look_;
  std::vector<float> depths_;
};

}  // namespace

void see_sky(Head& head) {
  float radius = 1;
  std::array<std::vector<Vec3>, kPartCount> normals;
  std::array<std::vector<float>, kPartCount> seen, all;
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    const Mesh& mesh = head.parts[part];
    for (const Vec3& p : mesh.positions) radius = std::max(radius, length(p));
    smooth_normals(mesh.positions, mesh.triangles, normals[part]);
    seen[part].resize(mesh.positions.size());
    all[part].resize(mesh.positions.size());
  }
  for (int i = 0; i < kSides; ++i) {
    const Vec3 from = side_of_sphere(i, kSides);
    const Depths depths(head, from, radius);
    for (std::size_t part = 0; part < head.parts.size(); ++part) {
      const Mesh& mesh = head.parts[part];
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const float facing = dot(normals[part][v], from);
        if (facing <= 0) continue;
        all[part][v] += facing;
        if (depths.sees(mesh.positions[v])) seen[part][v] += facing;
      }
    }
  }
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    Mesh& mesh = head.parts[part];
    if (mesh.occlusion.size() == mesh.positions.size()) continue;
    mesh.occlusion.resize(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const float share = all[part][v] > 0 ? seen[part][v] / all[part][v] : 0;
      mesh.occlusion[v] = kLeastLight + (1 - kLeastLight) * share;
    }
    const Part which = Part(part);
    const bool teeth = which == Part::upper_teeth || which == Part::lower_teeth;
    const float least = teeth ? kTeethLight : which == Part::tongue ? kTongueLight : 0;
    for (float& light : mesh.occlusion) light = std::max(light, least);
  }
}

}  // namespace animeme::head::detail
