#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"
#include "fap/head/detail/tube.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;
constexpr double kPupil = 1.0 / 3;  // of the iris, as the standard has it, and a little more

struct EyeColours {
  Vec3 white{0.80f, 0.775f, 0.75f};
  Vec3 iris, dark;
};

Vec3 eye_colour(const EyeColours& c, double r, double iris, double pupil, double angle) {
  const float lower = float(0.5 - 0.5 * std::sin(angle));  // 1 at the bottom
  if (r < pupil) return {0.006f, 0.005f, 0.005f};
  if (r > iris * 1.03) {
    const float t = float(smooth_step(iris * 1.03, iris * 1.25, r));
    return mix(c.dark * 2.5f, c.white, 0.45f + 0.55f * t);
  }
  const double t = (r - pupil) / (iris - pupil);
  const double fibre = 0.5 + 0.5 * std::sin(angle * 17) * std::sin(angle * 7 + 1);
  Vec3 colour = c.iris * float(0.75 + 0.35 * fibre) * (0.55f + 0.95f * lower);
  colour = mix(c.dark, colour, float(smooth_step(0.0, 0.22, t)));
  return mix(colour, c.dark, float(smooth_step(0.78, 1.0, t)));
}

}  // namespace

Mesh make_eye(const Shape& shape, int side) {
  const double iris = shape.p.iris;
  const double pupil = iris * kPupil * 1.2;
  const double radius = shape.p.eye_radius;
  std::vector<double> rings = {pupil * 0.5, pupil * 0.97, pupil * 1.03};
  for (const double t : {0.15, 0.35, 0.55, 0.75, 0.88, 0.99}) {
    rings.push_back(pupil + (iris - pupil) * t);
  }
  for (const double t : {1.035, 1.1, 1.25}) rings.push_back(iris * t);
  std::vector<double> angles;
  for (const double r : rings) angles.push_back(std::asin(r / radius));
  const double start = angles.back();
  for (int i = 1; i <= 10; ++i) angles.push_back(start + (pi - start) * i / 11.0);
  constexpr int kAround = 48;
  const EyeColours colours{.iris = linear_colour(shape.p.iris_colour),
                           .dark = linear_colour(shape.p.iris_colour) * 0.16f};
  const Vec3 centre(Vec3d{shape.eye.x * side, shape.eye.y, shape.eye.z});
  Mesh mesh;
  mesh.surface = SurfaceKind::eye;
  const auto add = [&](double polar, double a) {
    const double r = radius * std::sin(polar);
    const double z = radius * std::cos(polar);
    mesh.positions.push_back(centre + Vec3(Vec3d{r * std::cos(a), r * std::sin(a), z}));
    mesh.colours.push_back(z < 0 ? colours.white : eye_colour(colours, r, iris, pupil, a));
    const double top = r * std::sin(a) - shape.p.eye_opening * 0.5;  // the upper lid's shadow
    const double side_shade = smooth_step(0.6 * radius, 0.95 * radius, std::abs(r * std::cos(a)));
    mesh.occlusion.push_back(
        float((0.42 + 0.58 * smooth_step(0.10, -0.62, top)) * (1 - 0.45 * side_shade)));
  };
  add(0, 0);
  for (const double polar : angles) {
    for (int k = 0; k < kAround; ++k) add(polar, 2 * pi * k / kAround);
  }
  add(pi, 0);
  const auto at = [](std::size_t ring, int k) {
    return std::uint32_t(1 + ring * kAround + std::size_t(k % kAround));
  };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  for (int k = 0; k < kAround; ++k) {
    mesh.triangles.push_back({0, at(0, k), at(0, k + 1)});
    for (std::size_t ring = 0; ring + 1 < angles.size(); ++ring) {
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
    mesh.triangles.push_back({at(angles.size() - 1, k), last, at(angles.size() - 1, k + 1)});
  }
  return mesh;
}

Mesh make_brows(const Shape& shape) {
  constexpr int kSections = 28;
  std::vector<Section> sections;
  for (int i = 0; i < kSections; ++i) {
    const double t = double(i) / (kSections - 1);
    const Vec3d place = shape.brow(t);
    const Vec3d along =
        normalised(shape.brow(std::min(t + 0.03, 1.0)) - shape.brow(std::max(t - 0.03, 0.0)));
    const Vec3d out = gradient(shape.skin, place, 0.1);
    const Vec3d up = normalised(cross(out, along));
    const double taper =
        std::pow(std::sin(pi * std::clamp(0.035 + 0.945 * t, 0.0, 1.0)), 0.5) * (1.15 - 0.55 * t);
    const double half = shape.p.brow_thickness * taper;
    sections.push_back({place + out * 0.07, up * half, out * (0.10 + 0.25 * half)});
  }
  Mesh mesh;
  add_tube(sections, 10, mesh);
  const Vec3 colour = linear_colour(shape.p.brow_colour);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double hair = std::sin(double(i / 10) * 2.1 + double(i % 10) * 0.9);
    mesh.colours.push_back(colour * float(1.0 + 0.22 * hair));
  }
  mesh.occlusion.assign(mesh.positions.size(), 0.9f);
  mesh.surface = SurfaceKind::hair;
  append_mirrored(mesh, 0, 0);
  return mesh;
}

Mesh make_lashes(const Shape& shape, const Skin& skin, std::vector<std::uint32_t>& anchors) {
  const Layout& l = skin.layout;
  const int count = l.eye_outer - l.eye_inner + 1;
  Mesh mesh;
  std::vector<Section> sections;
  for (int k = 0; k < count; ++k) {
    const Vec3d rim = skin.places[skin.at(l.upper_lid, l.eye_inner + k)];
    const double t = double(k) / (count - 1);
    const double size = shape.p.lashes *
                        std::pow(std::sin(pi * std::min(0.06 + 0.62 * t, 0.62)), 1.2) *
                        (t > 0.97 ? 0.75 : 1.0);
    const Vec3d away = normalised(rim - shape.eye);
    const Vec3d side{0.55 * smooth_step(0.3, 1.0, t) - 0.25 * smooth_step(0.4, 0.0, t), 0, 0};
    const Vec3d tip = normalised(away * 0.9 + Vec3d{0, 0.42, 0} + side) * size;
    sections.push_back({rim + tip * 0.42 - Vec3d{0, 0.02, 0}, tip * 0.56,
                        normalised(cross(tip, Vec3d{1, 0, 0})) * (-0.028)});
  }
  constexpr int kAround = 6;
  if (shape.p.lashes > 0) add_tube(sections, kAround, mesh);
  for (int side : {1, -1}) {
    for (int k = 0; k < count && shape.p.lashes > 0; ++k) {
      const std::uint32_t anchor = skin.at(l.upper_lid, side * (l.eye_inner + k));
      anchors.insert(anchors.end(), kAround, anchor);
    }
  }
  mesh.colours.assign(mesh.positions.size(), Vec3{0.02f, 0.012f, 0.01f});
  mesh.occlusion.assign(mesh.positions.size(), 0.8f);
  mesh.surface = SurfaceKind::hair;
  append_mirrored(mesh, 0, 0);
  return mesh;
}

}  // namespace animeme::head::detail
