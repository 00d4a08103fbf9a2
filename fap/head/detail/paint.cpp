#include "fap/head/detail/paint.h"

#include "fap/head/srgb.h"

namespace animeme::head::detail {
namespace {

float linear(std::uint32_t byte) { return linear_of_srgb(float(byte & 255u) / 255.0f); }

float bump(double distance, double width) {
  return float(std::exp(-distance * distance / (width * width)));
}

Vec3 face_colour(const Shape& shape, Vec3d p) {
  const Vec3 skin = linear_colour(shape.p.skin_colour);
  const Vec3 blush = linear_colour(shape.p.cheek_colour);
  const double x = std::abs(p.x);
  Vec3 c = skin;
  if (p.z < 3) return c;
  c = mix(c, blush, 0.55f * bump(length(Vec3d{x - 4.0, (p.y + 2.7) * 1.2, 0}), 1.7));
  c = mix(c, blush, 0.35f * bump(length(Vec3d{x, p.y + shape.p.nose_length, 0}), 0.9));
  c = mix(c, blush, 0.15f * bump(length(Vec3d{x, p.y + shape.p.chin_drop - 1.2, 0}), 1.3));
  const double hole = length(Vec3d{x, p.y, p.z} - nostril(shape.p)) / shape.p.nose_size;
  c = mix(c, kMouthInside, 0.9f * smooth_step(0.62f, 0.36f, float(hole)));
  const double lid = length(Vec3d{(x - shape.eye.x) / 1.5, (p.y - 0.25) / 1.1, 0});
  return mix(c, blush * Vec3{0.9f, 0.82f, 0.85f}, 0.30f * bump(lid, 1.0));
}

// 0 outside of the lips, 1 inside of their contour.
float lip_share(const Layout& l, int row, int column) {
  const int beyond = std::abs(column) - l.mouth_corner;
  const float side = smooth_step(1.2f, -1.6f, float(beyond));
  const float above = smooth_step(float(l.upper_lip) - 0.5f, float(l.upper_lip) + 1.6f, float(row));
  const float below = smooth_step(float(l.lower_lip) + 0.5f, float(l.lower_lip) - 2.0f, float(row));
  return std::min(above, below) * side;
}

}  // namespace

Vec3 linear_colour(std::uint32_t srgb) {
  return {linear(srgb >> 16), linear(srgb >> 8), linear(srgb)};
}

void paint_skin(const Shape& shape, Skin& skin) {
  const Layout& l = skin.layout;
  const Vec3 lip = linear_colour(shape.p.lip_colour);
  Mesh& mesh = skin.mesh;
  mesh.colours.assign(skin.places.size(), kMouthInside);
  mesh.occlusion.assign(skin.places.size(), 1.0f);
  for (int row = 0; row < l.rows(); ++row) {
    for (int c = -l.back; c < l.back; ++c) {
      const std::uint32_t id = skin.at(row, c);
      Vec3 colour = face_colour(shape, skin.places[id]);
      const float share = lip_share(l, row, c);
      colour = mix(colour, lip, 0.9f * share);
      const bool contact = row == l.upper_contact || row == l.lower_contact;
      if (contact && l.in_mouth(std::abs(c))) colour = colour * (0.6f - 0.15f * share);
      const bool rim = row == l.upper_lid || row == l.lower_lid;
      if (rim && l.in_eye(std::abs(c))) {
        colour = row == l.upper_lid ? Vec3{0.10f, 0.045f, 0.035f} : mix(colour, lip, 0.3f);
      }
      mesh.colours[id] = colour;
    }
  }
}

}  // namespace animeme::head::detail
