// A square picture of triangles, seen from far away.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "fap/head/vector.h"

namespace animeme::head::detail {

/// One of `count` directions evenly over the sphere, along a spiral.
inline Vec3 side_of_sphere(int i, int count) {
  const float y = 1 - 2 * (float(i) + 0.5f) / float(count);
  const float angle = float(i) * float(std::numbers::pi * (3 - std::sqrt(5.0)));
  const float r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

/// Looks at the ball of a radius around the origin from one direction, without perspective.
class Look {
 public:
  /// `size` pixels across and down.
  Look(Vec3 from, float radius, int size)
      : from_(from), size_(size), scale_(float(size) / (2 * radius)) {
    right_ = normalised(cross(std::abs(from.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, from));
    up_ = cross(from, right_);
  }

  /// Pixels to the right and up; z grows towards the one who looks.
  Vec3 place(Vec3 p) const {
    const float half = float(size_) / 2;
    return {dot(p, right_) * scale_ + half, dot(p, up_) * scale_ + half, dot(p, from_)};
  }

  std::vector<Vec3> places(std::span<const Vec3> points) const {
    std::vector<Vec3> out;
    out.reserve(points.size());
    for (const Vec3& p : points) out.push_back(place(p));
    return out;
  }

  /// Calls pixel(index, z) for each pixel whose middle a triangle covers; corners are places.
  template <class Pixel>
  void draw(Vec3 a, Vec3 b, Vec3 c, Pixel pixel) const {
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::abs(area) < 1e-6f) return;
    // Pixels whose middles are within the box around the triangle: none for most small ones.
    const auto low = [](float x, float y, float z) {
      return int(std::ceil(std::max(0.0f, std::min({x, y, z}) - 0.5f)));
    };
    const auto high = [&](float x, float y, float z) {
      return int(std::floor(std::min(float(size_ - 1), std::max({x, y, z}) - 0.5f)));
    };
    const int left = low(a.x, b.x, c.x);
    const int right = high(a.x, b.x, c.x);
    const int top = high(a.y, b.y, c.y);
    for (int y = low(a.y, b.y, c.y); y <= top; ++y) {
      for (int x = left; x <= right; ++x) {
        const float px = float(x) + 0.5f;
        const float py = float(y) + 0.5f;
        const float u = ((px - a.x) * (c.y - a.y) - (py - a.y) * (c.x - a.x)) / area;
        const float v = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        pixel(std::size_t(y) * std::size_t(size_) + std::size_t(x),
              a.z + u * (b.z - a.z) + v * (c.z - a.z));
      }
    }
  }

 private:
  Vec3 from_, right_, up_;
  int size_;
  float scale_;
};

}  // namespace animeme::head::detail
