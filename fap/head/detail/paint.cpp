#include "fap/head/detail/paint.h"

#include "fap/head/srgb.h"

namespace animeme::head::detail {
namespace {

float linear(std::uint32_t byte) { return linear_of_srgb(float(byte & 255u) / 255.0f); }

float bump(double distance, double width) {
  return float(std::exp(-distance * distance / (width * width)));
}

// -1..1, smooth, over places in units of its size; not the same on both sides.
float noise(Vec3d p) {
  const Vec3d low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const Vec3d t = p - low;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    const auto cell = [](double l, int d) { return std::uint32_t(std::int32_t(l) + d); };
    std::uint32_t h = cell(low.x, dx) * 2654435761u + cell(low.y, dy) * 2246822519u +
                      cell(low.z, dz) * 3266489917u;
    h = (h ^ (h >> 15)) * 2246822519u;
    h = (h ^ (h >> 13)) * 3266489917u;
    const auto share = [](double u, int d) {
      const double s = u * u * (3 - 2 * u);
      return d != 0 ? s : 1 - s;
    };
    sum += (double(h >> 16 & 1023u) / 511.5 - 1) * share(t.x, dx) * share(t.y, dy) * share(t.z, dz);
  }
  return float(sum);
}

// Blood below, and pigment, are not the same everywhere.
Vec3 mottled(Vec3 c, Vec3d p, float freckles) {
  const float blood = 0.6f * noise(p * 0.55) + 0.4f * noise(p * 1.3 + Vec3d{9, 9, 9});
  const float tan = 0.5f * noise(p * 0.35 + Vec3d{50, 0, 0}) + 0.5f * noise(p * 2.2);
  c = c * Vec3{1 + 0.02f * blood, 1 - 0.085f * blood, 1 - 0.085f * blood} * (1 + 0.04f * tan);
  if (freckles <= 0) return c;
  const float spot = smooth_step(
      0.3f, 0.55f, noise(p * 3.1 + Vec3d{0, 70, 0}) + 0.35f * noise(p * 1.1 + Vec3d{0, 0, 30}));
  return mix(c, c * Vec3{0.74f, 0.55f, 0.45f}, freckles * spot);
}

// Pores are large on nose and cheeks, the neck has none; forehead, nose and chin shine.
Grain grain_at(const HeadParameters& h, Vec3d p) {
  const double x = std::abs(p.x);
  const auto near = [&](double px, double py, double wide, double high) {
    return bump(length(Vec3d{(x - px) / wide, (p.y - py) / high, 0}), 1) *
           smooth_step(3.0f, 6.0f, float(p.z));
  };
  const float nose = near(0, -0.75 * h.nose_length, 1.2, 1.9);
  const float forehead = near(0, h.brow_height + 2.3, 3.4, 2.4);
  const float chin = near(0, 0.7 - h.chin_drop, 1.4, 1.2);
  const float cheek = near(2.6, 0.3 - h.nose_length, 1.6, 1.6);
  const float lids = near(h.eye_distance, 0, 1.9, 1.1);
  const float face = smooth_step(-1.5f, 0.5f, float(p.y + h.chin_drop));
  return {
      face * std::clamp(0.5f + 0.5f * nose + 0.4f * cheek + 0.2f * chin - 0.3f * lids, 0.0f, 1.0f),
      std::clamp(0.75f + 0.55f * nose + 0.4f * forehead + 0.35f * chin, 0.0f, 2.0f)};
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
  const double across = length(Vec3d{x / 4.6, (p.y + 0.8 * shape.p.nose_length) / 2.4, 0});
  c = mottled(c, p,
              float(shape.p.freckles) * bump(across, 1) * smooth_step(2.0f, 5.0f, float(p.z)));
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
  mesh.grain.assign(skin.places.size(), Grain{});
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
      const Grain grain = grain_at(shape.p, skin.places[id]);
      const float wet = smooth_step(0.3f, 0.9f, share);
      mesh.grain[id] = {grain.relief * smooth_step(0.5f, 0.1f, share) - wet,
                        grain.gloss + (1.7f - grain.gloss) * wet};
    }
  }
}

}  // namespace animeme::head::detail
