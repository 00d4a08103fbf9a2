#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"

namespace animeme::head::detail {
namespace {

constexpr double kPi = std::numbers::pi;

// How a wave of strands runs over the hair: 0..1 at a place.
double strand(Vec3d p, double count, double bend) {
  const double around = std::atan2(p.x, p.z + 1.2);
  return 0.5 + 0.5 * std::sin(around * count + bend * std::sin(p.y * 0.35 + around) +
                              0.8 * std::sin(around * count * 0.37 + 1.3));
}

// Rolls of hair along lines on the skin, so that its edge has a body.
double rolls(const std::vector<Vec3d>& line, Vec3d p, double radius, double blend) {
  double d = 1e9;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    d = smooth_min(d, cone(p, line[i], line[i + 1], radius, radius), blend);
  }
  return d;
}

double bob_field(const Shape& shape, const HairLines& lines, Vec3d p) {
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
  d = smooth_min(d, rolls(lines.left, p, 0.62, 0.2), 0.9);
  d = smooth_min(d, rolls(lines.right, p, 0.62, 0.2), 0.9);
  const double parting = std::exp(-std::pow((p.x + 1.6) / 0.28, 2)) * smooth_step(6.0, 8.5, p.y) *
                         smooth_step(-3.0, 3.0, p.z);
  return d + 0.16 * parting + 0.075 * strand(p, 26, 1.0);
}

}  // namespace

HairLines hair_lines(const Shape& shape) {
  const auto on_skin = [&shape](std::initializer_list<std::array<double, 2>> places) {
    std::vector<Vec3d> line;
    for (const auto& [x, y] : places) line.push_back(shape.front(x, y));
    return line;
  };
  switch (shape.p.hair) {
    case HairStyle::bob:
      return {on_skin({{-1.7, 7.6}, {0.6, 6.6}, {2.9, 5.7}, {4.8, 4.4}, {5.9, 2.6}, {6.2, 0.6}}),
              on_skin({{-1.7, 7.6}, {-3.4, 6.4}, {-5.0, 4.5}, {-5.9, 2.6}, {-6.2, 0.6}})};
    case HairStyle::short_cut:
    case HairStyle::fringe:
      return {};
  }
  return {};
}

double hair_field(const Shape& shape, const HairLines& lines, Vec3d p) {
  return shape.p.hair == HairStyle::bob ? bob_field(shape, lines, p) : short_hair_field(shape, p);
}

Mesh make_hair(const Shape& shape) {
  if (shape.p.hair != HairStyle::bob) return make_short_hair(shape);
  const HairLines lines = hair_lines(shape);
  Mesh mesh =
      surface_nets([&](Vec3d p) { return hair_field(shape, lines, p); }, {-11.2, -10.4, -12.4},
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

}  // namespace animeme::head::detail
