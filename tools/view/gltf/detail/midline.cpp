#include "tools/view/gltf/detail/midline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace animeme::gltf {
namespace {

using head::Vec3;

// Shares of the distance of the eyes.
constexpr float kHalfWidth = 0.05f;
constexpr float kLength = 2.4f;
constexpr float kAsHigh = 0.02f;
constexpr float kArm = 0.07f;
constexpr float kFlat = 2.9f;          // rad: what bends less is no corner
constexpr float kOwnSurface = 0.005f;  // nearer hits of a ray are the surface that it starts from

// Whether a ray meets a triangle farther than `least` away (Moeller and Trumbore).
bool meets(Vec3 from, Vec3 direction, const std::array<Vec3, 3>& triangle, float least) {
  const Vec3 a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  const Vec3 p = cross(direction, b);
  const float volume = dot(a, p);
  if (volume == 0) return false;
  const Vec3 s = from - triangle[0];
  const float u = dot(s, p) / volume;
  if (u < 0 || u > 1) return false;
  const Vec3 q = cross(s, a);
  const float v = dot(direction, q) / volume;
  return v >= 0 && u + v <= 1 && dot(b, q) / volume > least;
}

}  // namespace

Midline::Midline(const SkinShapes& face, float middle, float between, float top)
    : face_(face), middle_(middle), between_(between) {
  const std::vector<Corners> triangles = triangles_near();
  face.for_skin([&](Spot spot) {
    const Vec3 p = face.place(spot);
    if (std::abs(p.x - middle) < kHalfWidth * between && p.y < top &&
        p.y > top - kLength * between && is_seen(p, triangles)) {
      spots_.push_back(spot);
    }
  });
  std::stable_sort(spots_.begin(), spots_.end(),
                   [&](Spot a, Spot b) { return face.place(a).y > face.place(b).y; });
}

// Triangles that a ray from a spot can meet: all rays stay in their plane of one x.
std::vector<Midline::Corners> Midline::triangles_near() const {
  std::vector<Corners> near;
  face_.for_skin_triangles([&](const Corners& corners) {
    const auto [least, most] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    if (least < middle_ + kHalfWidth * between_ && most > middle_ - kHalfWidth * between_) {
      near.push_back(corners);
    }
  });
  return near;
}

bool Midline::is_seen(Vec3 p, const std::vector<Corners>& triangles) const {
  const float diagonal = std::sqrt(0.5f);
  for (const Vec3 to_eye : {Vec3{0, 0, 1}, Vec3{0, -diagonal, diagonal}}) {
    const bool hidden = std::any_of(triangles.begin(), triangles.end(), [&](const Corners& t) {
      return meets(p, to_eye, t, kOwnSurface * between_);
    });
    if (!hidden) return true;
  }
  return false;
}

Spot Midline::best(float top, float bottom, const std::function<float(Vec3)>& measure) const {
  Spot found;
  float most = -std::numeric_limits<float>::infinity();
  for (const Spot spot : spots_) {
    const Vec3 p = face_.place(spot);
    const float value = measure(p) - 0.5f * std::abs(p.x - middle_);
    if (p.y > top || p.y < bottom || !(value > most)) continue;
    most = value;
    found = spot;
  }
  return found;
}

Spot Midline::at_height(float y) const {
  return best(y + between_, y - between_, [&](Vec3 p) { return -std::abs(p.y - y); });
}

// What bends most sharply within a distance of the middle; nothing if all is flat.
Spot Midline::corner_within(float reach, float top, float bottom) const {
  const float arm = kArm * between_;
  std::vector<Vec3> profile;
  std::vector<Spot> spots;
  for (const Spot spot : spots_) {
    const Vec3 p = face_.place(spot);
    if (std::abs(p.x - middle_) > reach || p.y > top + arm || p.y < bottom - arm) continue;
    profile.push_back({0, p.y, p.z});
    spots.push_back(spot);
  }
  Spot found;
  float sharpest = std::cos(kFlat);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (profile[i].y > top || profile[i].y < bottom) continue;
    Vec3 to_nose, to_lip;  // mean directions of what lies around
    for (const Vec3 other : profile) {
      const Vec3 d = other - profile[i];
      if (length(d) < arm) (d.y + d.z > 0 ? to_nose : to_lip) += d;
    }
    if (to_nose == Vec3{} || to_lip == Vec3{}) continue;
    to_nose = normalised(to_nose);
    to_lip = normalised(to_lip);
    if (to_nose.z + to_lip.z > 0 && dot(to_nose, to_lip) > sharpest) {
      sharpest = dot(to_nose, to_lip);
      found = spots[i];
    }
  }
  return found;
}

Spot Midline::corner(float top, float bottom) const {
  Spot found;
  // Between the nostrils, if the mesh has vertices there; they are open to the front and below.
  for (const float reach : {0.015f, 0.03f, kHalfWidth}) {
    if (!found.exists()) found = corner_within(reach * between_, top, bottom);
  }
  return found;
}

Spot Midline::nearest_middle(Spot spot, const std::function<bool(Spot)>& allowed) const {
  const float y = face_.place(spot).y;
  for (const Spot other : spots_) {
    const bool as_high = std::abs(face_.place(other).y - y) < kAsHigh * between_ && allowed(other);
    const float x = std::abs(face_.place(other).x - middle_);
    if (as_high && x < std::abs(face_.place(spot).x - middle_)) spot = other;
  }
  return spot;
}

}  // namespace animeme::gltf
