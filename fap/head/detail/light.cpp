#include "fap/head/detail/assemble.h"
#include "fap/head/detail/normals.h"
#include "fap/head/detail/paint.h"

namespace animeme::head::detail {

EarVertices add_ears(const Shape& shape, Mesh& skin) {
  EarVertices ears{};
  Mesh ear = make_left_ear(shape);
  const Vec3 base = linear_colour(shape.p.skin_colour);
  const Vec3 blush = linear_colour(shape.p.cheek_colour);
  // Light shines through where the ear is thin.
  std::vector<Vec3> normals;
  smooth_normals(ear.positions, ear.triangles, normals);
  for (std::size_t i = 0; i < ear.positions.size(); ++i) {
    const double below = ear_field(shape, Vec3d(ear.positions[i] - normals[i] * 0.45f));
    const float thin = smooth_step(-0.30f, 0.0f, float(below));
    const Vec3 red = blush * Vec3{1.05f, 0.74f, 0.68f};
    ear.colours.push_back(mix(mix(base, blush, 0.3f), red, 0.25f + 0.45f * thin));
  }
  ear.occlusion.assign(ear.positions.size(), 1.0f);
  const std::size_t triangles = skin.triangles.size();
  ears.left_first = std::uint32_t(skin.positions.size());
  append(skin, ear);
  ears.right_first = std::uint32_t(skin.positions.size());
  append_mirrored(skin, ears.left_first, triangles);
  ears.end = std::uint32_t(skin.positions.size());
  skin.grain.resize(skin.positions.size(), {0.4f, 0.8f});
  return ears;
}

namespace {

// Share of the light from above and before that reaches a place: soft shadows of nose, chin and
// hair.
template <class Field>
double open_front(const Field& field, Vec3d p, Vec3d normal) {
  constexpr std::array<Vec3d, 3> kLights = {
      {{0.42, 0.62, 0.66}, {0, 0.78, 0.62}, {-0.42, 0.62, 0.66}}};
  constexpr double kSoft = 3.5;  // the larger, the sharper their edges
  double open = 0;
  for (const Vec3d& light : kLights) {
    double least = 1;
    double way = 0.25;
    for (int i = 0; i < 7 && way < 7 && least > 0; ++i) {
      const double d = field(p + normal * 0.12 + light * way);
      least = std::min(least, kSoft * d / way);
      way += std::clamp(d, 0.4, 1.8);
    }
    open += std::max(least, 0.0);
  }
  return open / kLights.size();
}

template <class Field>
void shade_by(const Field& field, double reach, double strength, std::size_t count, Mesh& mesh) {
  std::vector<Vec3> normals;
  smooth_normals(mesh.positions, mesh.triangles, normals);
  mesh.occlusion.resize(mesh.positions.size(), 1.0f);
  for (std::size_t i = 0; i < count; ++i) {
    const double sky = open_sky(field, Vec3d(mesh.positions[i]), Vec3d(normals[i]), reach);
    mesh.occlusion[i] *= float(1 - strength * (1 - sky));
  }
}

}  // namespace

void shade_parts(const Shape& shape, const Skin& skin, Head& head) {
  const HairLines lines = hair_lines(shape);
  const auto all = [&](Vec3d p) {
    double d = std::min(shape.skin(p), hair_field(shape, lines, p));
    if (p.y < -7) d = std::min(d, body_field(shape, p));
    if (std::abs(p.x) > 5 && p.z < 4) d = std::min(d, ear_field(shape, p));
    return d;
  };
  Mesh& face = head.part(Part::skin);
  // Outer rows by the field; inside of the mouth the deeper the darker.
  const auto outside = std::size_t(skin.at(skin.layout.bottom, -1)) + 1;
  const std::size_t faces = skin.places.size();
  shade_by(all, 3.2, 0.85, outside, face);
  std::vector<Vec3> normals;
  smooth_normals(face.positions, face.triangles, normals);
  for (std::size_t i = 0; i < outside; ++i) {
    // Whose front is turned away is dark by itself, and hair hides the rest.
    const float before = smooth_step(-4.0f, 0.0f, face.positions[i].z) *
                         smooth_step(8.0f, 6.0f, face.positions[i].y);
    if (before == 0) continue;
    const double front = open_front(all, Vec3d(face.positions[i]), Vec3d(normals[i]));
    face.occlusion[i] *= 1 - 0.4f * before * float(1 - front);
  }
  const double lips = skin.places[skin.at(skin.layout.upper_contact, 0)].z;
  for (std::size_t i = outside; i < faces; ++i) {
    const double depth = lips - skin.places[i].z;
    const bool mouth = std::abs(skin.places[i].y + shape.p.mouth_drop) < 2.5;
    face.occlusion[i] = mouth ? float(std::max(0.6 - 0.30 * depth, 0.03)) : 0.6f;
  }
  Mesh ears;
  ears.positions.assign(face.positions.begin() + std::ptrdiff_t(faces), face.positions.end());
  for (const Triangle& t : face.triangles) {
    const auto base = std::uint32_t(faces);
    if (t[0] >= base) ears.triangles.push_back({t[0] - base, t[1] - base, t[2] - base});
  }
  shade_by(all, 1.6, 0.9, ears.positions.size(), ears);
  std::copy(ears.occlusion.begin(), ears.occlusion.end(),
            face.occlusion.begin() + std::ptrdiff_t(faces));
  Mesh& hair = head.part(Part::hair);
  shade_by(all, 3.0, 0.7, hair.positions.size(), hair);
  Mesh& body = head.part(Part::body);
  shade_by(all, 5.0, 0.8, body.positions.size(), body);
}

std::vector<float> freedom_below_hair(const Shape& shape, const Mesh& skin) {
  const HairLines lines = hair_lines(shape);
  std::vector<float> freedom;
  for (const Vec3& p : skin.positions) {
    // Faces move alike on both sides, even if the hair is not.
    const Vec3d left(p);
    const Vec3d right{-left.x, left.y, left.z};
    const double hair = std::min(hair_field(shape, lines, left), hair_field(shape, lines, right));
    freedom.push_back(float(smooth_step(-0.3, 0.0, hair)));
  }
  return freedom;
}

}  // namespace animeme::head::detail
