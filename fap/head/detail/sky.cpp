#include "fap/head/detail/own_steps.h"

#include <limits>
#include <numbers>

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

// A depth picture of all parts, seen from `from`: the sky is as far away as anything can be.
class Depths {
 public:
  Depths(const Head& head, Vec3 from, float radius)
      : from_(from), scale_(kSize / (2 * radius)), depths_(std::size_t(kSize) * kSize, kSky) {
    right_ = normalised(cross(std::abs(from.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, from));
    up_ = cross(from, right_);
    for (const Mesh& mesh : head.parts) {
      for (const Triangle& t : mesh.triangles) {
        draw(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
      }
    }
  }

  bool sees(Vec3 p) const {
    const Vec3 q = place(p);
    const int x = int(q.x);
    const int y = int(q.y);
    if (x < 0 || y < 0 || x >= kSize || y >= kSize) return true;
    return q.z + kOwn >= depths_[std::size_t(y) * kSize + std::size_t(x)];
  }

 private:
  static constexpr float kSky = std::numeric_limits<float>::lowest();

  // Pixels across and down; z grows towards the one who looks.
  Vec3 place(Vec3 p) const {
    return {dot(p, right_) * scale_ + kSize / 2, dot(p, up_) * scale_ + kSize / 2, dot(p, from_)};
  }

  void draw(Vec3 a, Vec3 b, Vec3 c) {
    a = place(a);
    b = place(b);
    c = place(c);
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::abs(area) < 1e-6f) return;
    const auto low = [](float x, float y, float z) {
      return std::max(0, int(std::floor(std::min({x, y, z}))));
    };
    const auto high = [](float x, float y, float z) {
      return std::min(kSize - 1, int(std::ceil(std::max({x, y, z}))));
    };
    for (int y = low(a.y, b.y, c.y); y <= high(a.y, b.y, c.y); ++y) {
      for (int x = low(a.x, b.x, c.x); x <= high(a.x, b.x, c.x); ++x) {
        const float px = float(x) + 0.5f;
        const float py = float(y) + 0.5f;
        const float u = ((px - a.x) * (c.y - a.y) - (py - a.y) * (c.x - a.x)) / area;
        const float v = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        float& depth = depths_[std::size_t(y) * kSize + std::size_t(x)];
        depth = std::max(depth, a.z + u * (b.z - a.z) + v * (c.z - a.z));
      }
    }
  }

  Vec3 from_, right_, up_;
  float scale_;
  std::vector<float> depths_;
};

// Evenly over the sphere, along a spiral.
Vec3 side(int i) {
  const float y = 1 - 2 * (float(i) + 0.5f) / kSides;
  const float angle = float(i) * float(std::numbers::pi * (3 - std::sqrt(5.0)));
  const float r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

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
    const Vec3 from = side(i);
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
