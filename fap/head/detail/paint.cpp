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
  if (shape.p.beard != Beard::none) {
    const float dark = shape.p.beard == Beard::full ? 0.8f : 0.4f;
    c = mix(c, mix(skin * 0.25f, linear_colour(shape.p.hair_colour), 0.5f),
            dark * beard_share(shape, p));
  }
  if (shape.p.hair == HairStyle::bald) {
    const Vec3 shaved = mix(skin, linear_colour(shape.p.hair_colour), 0.25f);
    const double around = std::atan2(std::abs(p.x), p.z);
    c = mix(c, shaved,
            float(smooth_step(3.5, 5.0, p.y + 2.5 * smooth_step(0.9, 1.5, around)) *
                  smooth_step(-7.0, -3.0, p.y)));
  }
  c = c * float(1 - 0.32 * age_line(shape.p, p));
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

float beard_share(const Shape& shape, Vec3d p) {
  const double x = std::abs(p.x);
  const HeadParameters& h = shape.p;
  // From below the ear to the corner of the mouth.
  const double line = -h.mouth_drop + 0.2 + 0.62 * std::max(x - h.mouth_width - 0.7, 0.0);
  const double cheek = smooth_step(0.5, -0.5, p.y - line);
  const double above = smooth_step(h.mouth_width + 0.9, h.mouth_width - 0.1, x) *
                       smooth_step(shape.nose_base() + 0.05, shape.nose_base() - 0.35, p.y);
  const double neck = smooth_step(-h.chin_drop - 2.4, -h.chin_drop - 0.6, p.y);
  // The skin beside and below the lower lip is bare.
  const double bare =
      1 - 0.55 * bump(length(Vec3d{(x - 1.7) / 0.6, (p.y + h.mouth_drop + 1.3) / 0.5, 0}), 1);
  return float(std::max(cheek, above) * neck * bare * smooth_step(-2.5, 0.5, p.z));
}

double age_line(const HeadParameters& h, Vec3d p) {
  if (h.lines <= 0 || p.z < 3) return 0;
  const double x = std::abs(p.x);
  const auto near = [&](Vec3d a, Vec3d b, double wide) {
    const Vec3d q{x, p.y, 0};
    const Vec3d ab = b - a;
    const double t = std::clamp(dot(q - a, ab) / dot(ab, ab), 0.0, 1.0);
    return double(bump(length(q - a - ab * t), wide)) * smooth_step(0.0, 0.2, t + 0.05) *
           smooth_step(1.0, 0.75, t - 0.02);
  };
  const double wing = -h.nose_length - 0.1;
  double depth = near({1.15, wing + 0.2, 0}, {h.mouth_width + 0.95, -h.mouth_drop - 0.3, 0}, 0.26);
  depth = std::max(depth, 0.4 * near({h.mouth_width + 0.25, -h.mouth_drop - 0.35, 0},
                                     {h.mouth_width + 0.1, -h.mouth_drop - 1.7, 0}, 0.24));
  for (const double above : {1.5, 2.5, 3.5}) {
    const double y = h.brow_height + above + 0.08 * std::cos(x);
    depth = std::max(depth, 0.42 * bump(p.y - y, 0.24) * smooth_step(4.2, 2.6, x));
  }
  const double outer = h.eye_distance + h.eye_width / 2;
  for (const double turn : {-0.35, 0.1, 0.5}) {
    depth = std::max(depth, 0.5 * near({outer + 0.25, 0.15 + 0.3 * turn, 0},
                                       {outer + 1.25, 0.2 + turn, 0}, 0.16));
  }
  // Below the eyes.
  depth = std::max(
      depth, 0.5 * near({h.eye_distance - 1.3, -0.95, 0}, {h.eye_distance + 0.9, -1.45, 0}, 0.28));
  return h.lines * depth;
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
