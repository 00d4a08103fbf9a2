#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"

namespace animeme::head::detail {
namespace {

constexpr double kPi = std::numbers::pi;

// Into the ear's own axes: x outwards, y up, z to the back, in units of its size.
Vec3d to_ear(const Shape& shape, Vec3d p) {
  const Vec3d hole{shape.p.skull_width * 0.86, -1.15, -0.1};
  const Vec3d q = (p - hole) * (1 / shape.p.ear);
  const double turn = 0.45;  // the back edge stands off
  const double lean = 0.16;  // the top leans back
  const double x = std::cos(turn) * q.x + std::sin(turn) * q.z;
  const double back = -std::cos(turn) * q.z + std::sin(turn) * q.x;
  return {x, std::cos(lean) * q.y + std::sin(lean) * back * -1.0,
          std::cos(lean) * back * 1.0 - std::sin(lean) * q.y * 1.0};
}

// Distance to an oval ring of the given half axes and thickness.
double ring(Vec3d p, double height, double depth, double out, double radius) {
  const double r = std::sqrt(p.y * p.y / (height * height) + p.z * p.z / (depth * depth));
  return std::hypot((r - 1) * 0.5 * (height + depth) * 0.85, p.x - out) - radius;
}

// How a wave of strands runs over the hair: 0..1 at a place.
double strand(Vec3d p, double count, double bend) {
  const double around = std::atan2(p.x, p.z + 1.2);
  return 0.5 + 0.5 * std::sin(around * count + bend * std::sin(p.y * 0.35 + around) +
                              0.8 * std::sin(around * count * 0.37 + 1.3));
}

double bob_field(const Shape& shape, Vec3d p) {
  const HeadParameters& h = shape.p;
  const double x = std::abs(p.x);
  const double cap =
      ellipsoid(p - Vec3d{0, 3.5, -0.7}, {h.skull_width + 0.85, h.skull_height + 0.75, 9.7});
  // Wider towards its ends, which turn in at the neck.
  const double drop = std::clamp((2.0 - p.y) / 9.0, 0.0, 1.0);
  const Vec3d q{x, 0, p.z + 1.6};
  const double wide = 8.1 + 0.75 * std::sin(kPi * std::min(drop * 0.95, 1.0));
  const double sides = (std::hypot(q.x / wide, q.z / 8.6) - 1) * 8.2;
  const double ends = smooth_max(-(p.y + 7.6 + 0.25 * strand(p, 9, 0)), p.y - 3.0, 1.0);
  double d = smooth_min(cap, smooth_max(sides, ends, 1.4), 1.6);
  // The face looks out; a parting on the right.
  const double shift = p.x + 0.7;
  const double arch = 5.95 - 0.045 * shift * shift + 0.12 * p.x;
  const double face = smooth_max(
      x - 5.25 - 0.05 * (p.y - 1) - 0.10 * std::max(8.0 - p.z, 0.0) * -1.0, p.y - arch, 2.4);
  const double front = smooth_max(face, 2.2 - p.z, 1.0);
  d = smooth_max(d, -front, 0.8);
  const double parting = std::exp(-std::pow((p.x + 1.6) / 0.28, 2)) * smooth_step(6.0, 8.5, p.y) *
                         smooth_step(-3.0, 3.0, p.z);
  return d + 0.16 * parting + 0.075 * strand(p, 26, 1.0);
}

double short_field(const Shape& shape, Vec3d p) {
  const HeadParameters& h = shape.p;
  const double x = std::abs(p.x);
  const double side =
      ellipsoid(p - Vec3d{0, 3.4, -0.5}, {h.skull_width + 0.30, h.skull_height + 0.3, 9.3});
  const double top = ellipsoid(p - Vec3d{0.3, 6.6, 0.3}, {6.6, 5.8, 8.4});
  double d = smooth_min(side, top, 1.2);
  const double wave =
      0.14 * std::sin(p.x * 1.5 + 0.5 * p.z + std::sin(p.z * 0.8)) * smooth_step(7.0, 9.5, p.y);
  const double arch = 6.1 - 0.035 * x * x + wave;
  const double face = smooth_max(p.y - arch, 1.8 - p.z - 0.12 * p.y, 1.6);
  d = smooth_max(d, -face, 0.5);
  const double neck = -(p.y + 4.2 + 0.42 * p.z + 0.3 * x * 0.0);
  d = smooth_max(d, neck, 0.8);
  const double ear = ellipsoid(Vec3d{x, p.y, p.z} - Vec3d{7.6, -2.0, -0.2}, {2.5, 3.5, 2.4});
  d = smooth_max(d, -ear, 0.5);
  return d + 0.06 * strand(p, 30, 2.0);
}

double fringe_field(const Shape& shape, Vec3d p) {
  const HeadParameters& h = shape.p;
  const double x = std::abs(p.x);
  double d = ellipsoid(p - Vec3d{0, 3.5, -0.6}, {h.skull_width + 0.7, h.skull_height + 0.7, 9.75});
  const double tips = 0.55 * std::abs(std::sin(p.x * 1.25 + 0.4)) + 0.2 * std::sin(p.x * 0.6);
  const double arch = 4.9 - tips - 0.03 * x * x;
  const double face = smooth_max(p.y - arch, 2.6 - p.z - 0.1 * p.y, 1.2);
  d = smooth_max(d, -face, 0.45);
  const double jag = 0.35 * std::abs(std::sin(4 * std::atan2(p.x, -p.z) + 0.5));
  d = smooth_max(d, -(p.y + 3.6 + 0.35 * p.z + jag), 0.7);
  const double ear = ellipsoid(Vec3d{x, p.y, p.z} - Vec3d{7.8, -2.4, 0.0}, {2.4, 3.2, 2.2});
  d = smooth_max(d, -ear, 0.5);
  const Vec3d tuft = p - Vec3d{0.4, 11.3, -3.6};
  d = smooth_min(d, ellipsoid(tuft, {0.9, 1.1, 1.3}), 1.2);
  return d + 0.10 * strand(p, 16, 1.4);
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
  const Vec3d middle{shape.p.skull_width * 0.86, -1.15, -0.1};
  return surface_nets([&shape](Vec3d p) { return ear_field(shape, p); },
                      middle - Vec3d{2.4, 3.2, 2.8} * s, middle + Vec3d{2.2, 3.2, 2.8} * s,
                      0.16 * s / std::sqrt(shape.p.density));
}

double hair_field(const Shape& shape, Vec3d p) {
  switch (shape.p.hair) {
    case HairStyle::bob:
      return bob_field(shape, p);
    case HairStyle::short_cut:
      return short_field(shape, p);
    case HairStyle::fringe:
      return fringe_field(shape, p);
  }
  return 1;
}

Mesh make_hair(const Shape& shape) {
  Mesh mesh =
      surface_nets([&shape](Vec3d p) { return hair_field(shape, p); }, {-11.2, -10.4, -12.4},
                   {11.2, 14, 11.2}, 0.4 / std::sqrt(shape.p.density));
  const Vec3 colour = linear_colour(shape.p.hair_colour);
  for (const Vec3& v : mesh.positions) {
    const Vec3d p(v);
    const float streak = float(0.6 * strand(p, 41, 1.5) + 0.4 * strand(p, 97, 2.5));
    mesh.colours.push_back(colour * (0.72f + 0.6f * streak));
  }
  mesh.material = Material::hair;
  return mesh;
}

double body_field(const Shape& shape, Vec3d p) {
  const double x = std::abs(p.x);
  const double n = shape.p.neck;
  const Vec3d q{x, p.y, p.z};
  double d = ellipsoid(q - Vec3d{0, -24, -3.4}, {n * 3.3, 8.2, 6.6});
  d = smooth_min(d, cone(q, {1.5, -15.6, -3.4}, {n * 2.9, -18.4, -3.6}, 2.9, 2.7), 2.6);
  // The collar stands a little off the neck.
  const Vec3d c = q - Vec3d{0, -13.9 - 0.16 * (p.z + 2.6), -2.6};
  const double around = std::hypot(c.x, c.z) - (n * 1.06 + 0.45);
  const double collar = std::hypot(around, c.y * 0.55) - 0.42;
  d = smooth_min(d, collar, 1.1);
  const double hole = std::max(std::hypot(c.x, c.z) - (n * 1.06 + 0.25), -c.y - 1.5);
  return smooth_max(d, -hole, 0.3);
}

Mesh make_body(const Shape& shape) {
  const double wide = shape.p.neck * 4.2;
  const auto field = [&shape](Vec3d p) { return std::max(body_field(shape, p), -24.0 - p.y); };
  Mesh mesh = surface_nets(field, {-wide, -25, -12}, {wide, -11, 6}, 0.55);
  mesh.colours.assign(mesh.positions.size(), linear_colour(shape.p.cloth_colour));
  mesh.material = Material::cloth;
  return mesh;
}

}  // namespace animeme::head::detail
