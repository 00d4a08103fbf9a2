#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"

namespace animeme::head::detail {
namespace {

constexpr double kCollarMiddle = -2.6;  // z

// Into the ear's own axes: x outwards, y up, z to the back, in units of its size.
Vec3d to_ear(const Shape& shape, Vec3d p) {
  Vec3d q = (p - shape.ear) * (1 / shape.p.ear);
  q.x -= 0.06 + shape.ear_lean * q.y;
  const double turn = 0.36;  // the back edge stands off
  const double lean = 0.16;  // the top leans back
  const double x = std::cos(turn) * q.x + std::sin(turn) * q.z;
  const double back = -std::cos(turn) * q.z + std::sin(turn) * q.x;
  return {x, std::cos(lean) * q.y - std::sin(lean) * back,
          std::cos(lean) * back - std::sin(lean) * q.y};
}

// Distance to an oval ring of the given half axes and thickness.
double ring(Vec3d p, double height, double depth, double out, double radius) {
  const double r = std::sqrt(p.y * p.y / (height * height) + p.z * p.z / (depth * depth));
  return std::hypot((r - 1) * 0.5 * (height + depth) * 0.85, p.x - out) - radius;
}

}  // namespace

double ear_field(const Shape& shape, Vec3d p) {
  const Vec3d q = to_ear(shape, {std::abs(p.x), p.y, p.z});
  const double plate = ellipsoid(q - Vec3d{-0.05, 0.1, 0.1}, {0.30, 2.0, 1.25});
  double d = smooth_min(plate, ring(q - Vec3d{0, 0.25, 0.1}, 1.85, 1.18, 0.10, 0.24), 0.25);
  d = smooth_max(d, -ellipsoid(q - Vec3d{0.42, -0.25, -0.15}, {0.5, 0.85, 0.62}), 0.25);
  const double fold = ring(q - Vec3d{0, 0.0, 0.0}, 1.15, 0.72, 0.12, 0.15);
  d = smooth_min(d, smooth_max(fold, -q.z - 0.1, 0.3), 0.25);
  d = smooth_min(d, ellipsoid(q - Vec3d{-0.02, -1.75, -0.3}, {0.3, 0.5, 0.5}), 0.4);
  d = smooth_min(d, ellipsoid(q - Vec3d{0.12, -0.3, -0.85}, {0.25, 0.4, 0.28}), 0.3);
  const double root = ellipsoid(q - Vec3d{-0.75, -0.2, -0.25}, {0.8, 1.3, 0.85});
  return smooth_min(d, root, 0.4) * shape.p.ear;
}

Mesh make_left_ear(const Shape& shape) {
  const double s = shape.p.ear;
  return surface_nets([&shape](Vec3d p) { return ear_field(shape, p); },
                      shape.ear - Vec3d{2.4, 3.2, 2.8} * s, shape.ear + Vec3d{2.4, 3.2, 2.8} * s,
                      0.155 * s / std::sqrt(shape.p.density));
}

namespace {

// Height of the collar's middle line, which is tilted, and its distance from the middle of the
// neck.
double collar_height(const Shape& shape, double z) {
  return -3.9 - shape.p.chin_drop - 0.16 * (z - kCollarMiddle);
}
double collar_radius(const Shape& shape) { return shape.p.neck * 1.08 + 0.15; }

// Shoulders, up to the collar.
double shoulders(const Shape& shape, Vec3d p) {
  const double n = shape.p.neck, above = 9.8 - shape.p.chin_drop;  // it stays below the chin
  const Vec3d q{std::abs(p.x), p.y - above, p.z};
  double d = ellipsoid(q - Vec3d{0, -24, -3.4}, {n * 3.3, 8.2, 6.6});
  d = smooth_min(d, cone(q, {1.5, -15.6, -3.4}, {n * 2.9, -18.4, -3.6}, 2.9, 2.7), 2.6);
  const double from_neck = std::hypot(p.x, p.z - kCollarMiddle) - collar_radius(shape);
  return smooth_min(d, smooth_max(from_neck - 0.5, p.y - collar_height(shape, p.z) + 0.1, 0.2),
                    0.8);
}

}  // namespace

double body_field(const Shape& shape, Vec3d p) {
  const double from_neck = std::hypot(p.x, p.z - kCollarMiddle) - collar_radius(shape);
  const double above = std::abs(p.y - collar_height(shape, p.z));
  return smooth_min(shoulders(shape, p),
                    std::hypot(std::max(above - 0.5, 0.0), from_neck - 0.42) - 0.42, 0.7);
}

Mesh make_body(const Shape& shape) {
  constexpr std::uint32_t kAlong = 72, kAround = 12;
  const double wide = shape.p.neck * 4.2;
  const auto field = [&shape](Vec3d p) { return std::max(shoulders(shape, p), -19.0 - p.y); };
  Mesh mesh = surface_nets(field, {-wide, -20, -12}, {wide, -8.5, 6}, 0.44);
  // A rolled collar that stands a little off the neck; a net would have teeth.
  const auto first = std::uint32_t(mesh.positions.size());
  for (std::uint32_t i = 0; i < kAlong; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAlong;
    const Vec3d out{std::sin(angle), 0, std::cos(angle)};
    Vec3d middle = out * (collar_radius(shape) + 0.42) + Vec3d{0, 0, kCollarMiddle};
    middle.y = collar_height(shape, middle.z);
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const double a = 2 * std::numbers::pi * k / kAround;
      mesh.positions.push_back(
          Vec3(middle + out * (0.45 * std::cos(a)) + Vec3d{0, 0.92 * std::sin(a), 0}));
      const auto at = [&](std::uint32_t row, std::uint32_t column) {
        return first + row % kAlong * kAround + column % kAround;
      };
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  mesh.colours.assign(mesh.positions.size(), linear_colour(shape.p.cloth_colour));
  mesh.surface = SurfaceKind::cloth;
  return mesh;
}

}  // namespace animeme::head::detail
