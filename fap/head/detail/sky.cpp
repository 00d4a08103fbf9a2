#include "fap/head/detail/own_steps.h"

#include <algorithm>
#include <cmath>
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
constexpr float kOwn = 0.12f;    // cm: a surface does not hide itself
constexpr float kMostSlope = 4;  // of a surface that is allowed for: pixels of depth a pixel
constexpr float kHeadBall = 24;  // cm around the eyes: head, hair and neck
constexpr float kFade = 0.75f;   // of it: from here on what the whole body's picture shows

struct SkyBall {
  Vec3 centre;
  float radius;  // cm
};

// A depth picture of all parts: the sky is as far away as anything can be.
class Depths {
 public:
  Depths(const Head& head, Vec3 from, SkyBall place)
      : look_(from, place.radius, kSize),
        centre_(place.centre),
        pixel_(2 * place.radius / kSize),
        depths_(std::size_t(kSize) * kSize, kSky) {
    for (const Mesh& mesh : head.parts) {
      std::vector<Vec3> places;
      places.reserve(mesh.positions.size());
      for (const Vec3& p : mesh.positions) places.push_back(look_.place(p - centre_));
      for (const Triangle& t : mesh.triangles) {
        look_.draw(places[t[0]], places[t[1]], places[t[2]],
                   [&](std::size_t i, float z) { depths_[i] = std::max(depths_[i], z); });
      }
    }
  }

  // `facing`: cosine between the surface's normal and the direction, above 0. The picture has one
  // depth a pixel: within it a slanting surface is nearer than itself.
  bool sees(Vec3 p, float facing) const {
    const Vec3 q = look_.place(p - centre_);
    const int x = int(q.x);
    const int y = int(q.y);
    if (x < 0 || y < 0 || x >= kSize || y >= kSize) return true;
    const float slope =
        std::min(std::sqrt(std::max(0.0f, 1 - facing * facing)) / facing, kMostSlope);
    const float own = std::max(kOwn, pixel_ * slope);
    return q.z + own >= depths_[std::size_t(y) * kSize + std::size_t(x)];
  }

 private:
  static constexpr float kSky = std::numeric_limits<float>::lowest();

  Look look_;
  Vec3 centre_;
  float pixel_;  // cm
  std::vector<float> depths_;
};

using Light = std::array<std::vector<float>, kPartCount>;

// The share of the sky that each vertex sees, of that which it faces.
Light seen_sky(const Head& head, const std::array<std::vector<Vec3>, kPartCount>& normals,
               SkyBall place) {
  Light seen, all;
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    seen[part].resize(head.parts[part].positions.size());
    all[part].resize(head.parts[part].positions.size());
  }
  for (int i = 0; i < kSides; ++i) {
    const Vec3 from = side_of_sphere(i, kSides);
    const Depths depths(head, from, place);
    for (std::size_t part = 0; part < head.parts.size(); ++part) {
      const Mesh& mesh = head.parts[part];
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const float facing = dot(normals[part][v], from);
        if (facing <= 0) continue;
        all[part][v] += facing;
        if (depths.sees(mesh.positions[v], facing)) seen[part][v] += facing;
      }
    }
  }
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    for (std::size_t v = 0; v < seen[part].size(); ++v) {
      seen[part][v] = all[part][v] > 0 ? seen[part][v] / all[part][v] : 0;
    }
  }
  return seen;
}

}  // namespace

void see_sky(Head& head) {
  const Vec3 eyes = 0.5f * (head.eyes[0].centre + head.eyes[1].centre);
  float around_eyes = 1;
  std::array<std::vector<Vec3>, kPartCount> normals;
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    const Mesh& mesh = head.parts[part];
    for (const Vec3& p : mesh.positions) around_eyes = std::max(around_eyes, length(p - eyes));
    smooth_normals(mesh.positions, mesh.triangles, normals[part]);
  }
  // A head that has a body gets pictures of its own: those of the body have pixels of 2 cm.
  const SkyBall near{eyes, std::min(around_eyes, kHeadBall)};
  Light light = seen_sky(head, normals, near);
  if (around_eyes > near.radius) {
    const Light far = seen_sky(head, normals, {eyes, around_eyes});
    for (std::size_t part = 0; part < head.parts.size(); ++part) {
      for (std::size_t v = 0; v < light[part].size(); ++v) {
        const float away = length(head.parts[part].positions[v] - eyes) / near.radius;
        const float share = std::clamp((away - kFade) / (1 - kFade), 0.0f, 1.0f);
        light[part][v] += share * (far[part][v] - light[part][v]);
      }
    }
  }
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    Mesh& mesh = head.parts[part];
    if (mesh.occlusion.size() == mesh.positions.size()) continue;
    mesh.occlusion.resize(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      mesh.occlusion[v] = kLeastLight + (1 - kLeastLight) * light[part][v];
      if (normals[part][v] == Vec3{}) mesh.occlusion[v] = 1;  // of transparent triangles
    }
    const Part which = Part(part);
    const bool teeth = which == Part::upper_teeth || which == Part::lower_teeth;
    const float least = teeth ? kTeethLight : which == Part::tongue ? kTongueLight : 0;
    for (float& bright : mesh.occlusion) bright = std::max(bright, least);
  }
}

}  // namespace animeme::head::detail
