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

// A cap of hair: the skin, thicker where hair grows. Its lower edge runs around the head at heights
// over the angle from the front.
struct Cap {
  std::array<double, 9> angles;  // rad, 0 = front, rising to pi
  std::array<double, 9> heights;
  double sides, top, front;  // thickness, cm
  double edge;               // from nothing to full thickness, cm
  double strands;            // depth of the grooves
};

constexpr Cap kShortCut{{0, 0.45, 0.72, 0.90, 1.05, 1.30, 1.48, 1.85, 3.15},
                        {6.5, 6.2, 5.2, 3.3, 0.8, -1.4, 1.3, -3.2, -5.4},
                        0.34,
                        0.95,
                        0.45,
                        1.5,
                        0.13};
constexpr Cap kFringe{{0, 0.40, 0.70, 0.95, 1.12, 1.30, 1.48, 1.85, 3.15},
                      {5.7, 5.5, 4.5, 2.3, -0.3, -1.6, 1.2, -3.0, -4.6},
                      0.75,
                      0.95,
                      0.25,
                      0.62,
                      0.10};

double edge_height(const Cap& cap, double angle) {
  std::size_t i = 0;
  while (i + 2 < cap.angles.size() && angle > cap.angles[i + 1]) ++i;
  return cap.heights[i] + (cap.heights[i + 1] - cap.heights[i]) *
                              smooth_step(cap.angles[i], cap.angles[i + 1], angle);
}

double cap_field(const Shape& shape, const Cap& cap, double jag, Vec3d p) {
  const double skin = shape.skin(p);
  if (skin > 4) return skin - 2;  // far from any hair
  const double angle = std::atan2(std::abs(p.x), p.z);
  const double front = smooth_step(1.3, 0.6, angle);
  const double tips = jag * std::abs(std::sin(p.x * 1.15 + 0.5)) * front;
  const double inside = (p.y - edge_height(cap, angle) + tips) * 0.8;
  const double up = smooth_step(2.5, 8.0, p.y);
  const double quiff = front * smooth_step(4.5, 7.0, p.y) * smooth_step(11.5, 8.0, p.y);
  const double full = cap.sides + (cap.top - cap.sides) * up + cap.front * quiff;
  const double grown =
      full * smooth_step(-0.15, cap.edge, inside) - 0.25 * smooth_step(0.0, -0.3, inside);
  const double hair =
      skin - grown + cap.strands * strand(p, 24, 1.6) * smooth_step(0.0, 1.0, inside);
  // Nothing is left inside of the head below the edge.
  return smooth_max(hair, -inside - 0.7, 0.2) * 0.8;
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
  switch (shape.p.hair) {
    case HairStyle::bob:
      return bob_field(shape, lines, p);
    case HairStyle::short_cut:
      return cap_field(shape, kShortCut, 0, p);
    case HairStyle::fringe:
      return cap_field(shape, kFringe, 0.7, p);
  }
  return 1;
}

Mesh make_hair(const Shape& shape) {
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
