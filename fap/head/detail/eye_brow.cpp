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

// 0..1, scattered over i.
double hair_scatter(int i) {
  std::uint32_t h = std::uint32_t(i) * 2654435761u;
  h = (h ^ (h >> 15)) * 2246822519u;
  return double((h ^ (h >> 13)) >> 8 & 1023u) / 1023;
}

// A hair that bends from `root` along `way` towards `bend`, and thins out.
void add_hair(Vec3d root, Vec3d way, Vec3d bend, Vec3d outwards, double thickness, Mesh& mesh) {
  constexpr int kPlaces = 3, kAround = 3;
  std::vector<Section> sections;
  for (int i = 0; i < kPlaces; ++i) {
    const double t = double(i) / (kPlaces - 1);
    const Vec3d along = normalised(way + bend * (2 * t));
    const Vec3d up = normalised(cross(outwards, along));
    const double half = thickness * (1 - 0.85 * t * t);
    sections.push_back({root + way * t + bend * (t * t), up * half, cross(along, up) * half});
  }
  add_tube(sections, kAround, mesh);
}

// Hairs where the beard is dense, on the left side.
void add_beard(const Shape& shape, Mesh& mesh) {
  constexpr double kStep = 0.28;
  const Vec3 colour = linear_colour(shape.p.hair_colour);
  const double low = -shape.p.chin_drop - 0.4, high = -shape.p.nose_length;
  int seed = 0;
  for (double y = low; y < high; y += kStep) {
    for (double x = 0.08; x < 5.2; x += kStep, ++seed) {
      const double px = x + 1.2 * kStep * (hair_scatter(seed) - 0.5);
      const double py = y + 1.2 * kStep * (hair_scatter(seed + 5000) - 0.5);
      const bool lips = px < shape.p.mouth_width * 1.1 && py < shape.upper_lip(px) + 0.12 &&
                        py > shape.lower_lip(px) - 0.18;
      const Vec3d root = shape.front(std::max(px, 0.02), py);
      if (lips || root.z < 1.5 || beard_share(shape, root) < 0.75) continue;
      const Vec3d out = normalised(gradient(shape.skin, root, 0.15));
      const Vec3d down =
          normalised(Vec3d{0.25 * px, -1, 0.1} - out * dot(Vec3d{0.25 * px, -1, 0.1}, out));
      const double size = 0.3 + 0.25 * hair_scatter(seed + 9000);
      add_hair(root, (down * 0.8 + out * 0.4) * size, (down * 0.3 - out * 0.25) * size, out, 0.045,
               mesh);
      const float tint = float(0.7 + 0.6 * hair_scatter(seed + 12000));
      mesh.colours.resize(mesh.positions.size(), colour * tint);
    }
  }
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
  // Hairs in rows from the lower edge up; they lie towards the temple, at the nose they rise.
  constexpr int kAlong = 30, kRows = 4;
  const Vec3 colour = linear_colour(shape.p.brow_colour);
  Mesh mesh;
  for (int i = 0; i < kAlong; ++i) {
    for (int row = 0; row < kRows; ++row) {
      const int seed = i * kRows + row;
      const double t = 0.93 * (i + hair_scatter(seed) * 0.9) / kAlong;  // the hairs reach on to 1
      const double taper =
          std::pow(std::sin(pi * std::clamp(0.06 + 0.92 * t, 0.0, 1.0)), 0.6) * (1.15 - 0.55 * t);
      const double half = shape.p.brow_thickness * taper;
      const double across = -1 + 2 * (row + hair_scatter(seed + 400)) / kRows;
      const Vec3d middle = shape.brow(t);
      const Vec3d along =
          normalised(shape.brow(std::min(t + 0.03, 1.0)) - shape.brow(std::max(t - 0.03, 0.0)));
      const Vec3d out = normalised(gradient(shape.skin, middle, 0.1));
      const Vec3d up = normalised(cross(out, along));
      const Vec3d beside = middle + up * (half * across);
      const Vec3d root = shape.front(beside.x, beside.y) + out * 0.02;
      const double rise =
          1.3 - 1.1 * smooth_step(0.0, 0.35, t) - 0.5 * across * smooth_step(0.1, 0.4, t);
      const double size = 0.5 + 0.25 * hair_scatter(seed + 800) - 0.15 * smooth_step(0.7, 1.0, t);
      const Vec3d way = normalised(along + up * rise) * size;
      const Vec3d bend = (along - up * (0.4 * rise)) * (0.35 * size) + out * (-0.06);
      add_hair(root, way + out * 0.11, bend, out, 0.047, mesh);
      const float tint = float(0.8 + 0.5 * hair_scatter(seed + 1200));
      mesh.colours.resize(mesh.positions.size(), colour * tint);
    }
  }
  if (shape.p.beard == Beard::full) add_beard(shape, mesh);
  mesh.occlusion.assign(mesh.positions.size(), 0.9f);
  mesh.surface = SurfaceKind::hair;
  append_mirrored(mesh, 0, 0);
  return mesh;
}

Mesh make_lashes(const Shape& shape, const Skin& skin, std::vector<std::uint32_t>& anchors) {
  const Layout& l = skin.layout;
  const int count = l.eye_outer - l.eye_inner + 1;
  Mesh mesh;
  std::vector<int> columns;  // of the left half, of each vertex; negative: the lower rim
  const auto anchor = [&](int column, bool upper) {
    columns.resize(mesh.positions.size(), upper ? column : -column);
  };
  const auto grow = [&](bool upper, double size, double thickness, int between) {
    for (int k = 0; k + 1 < count * between; ++k) {
      const double t = double(k) / (count * between - 1);
      const int column = l.eye_inner + k / between;
      const int row = upper ? l.upper_lid : l.lower_lid;
      const double share = double(k % between) / between;
      const Vec3d here = skin.places[skin.at(row, column)];
      const Vec3d next = skin.places[skin.at(row, std::min(column + 1, l.eye_outer))];
      const Vec3d root = mix(here, next, share);
      const double full = size * (0.45 + 0.55 * std::sin(pi * std::min(0.06 + 0.62 * t, 0.62))) *
                          (0.8 + 0.4 * hair_scatter(k + (upper ? 0 : 500))) *
                          smooth_step(0.0, 0.12, t) * (t > 0.97 ? 0.7 : 1.0);
      if (full < 0.03) continue;
      const Vec3d away = normalised(root - shape.eye);
      const double aside = 0.65 * smooth_step(0.3, 1.0, t) - 0.35 * smooth_step(0.4, 0.0, t);
      const double rise = upper ? 0.05 : -0.25;
      const Vec3d way = normalised(away + Vec3d{aside, rise, 0}) * (full * 0.75);
      const Vec3d bend = Vec3d{aside * 0.25, upper ? 0.55 : -0.4, 0} * (full * 0.6);
      add_hair(root, way, bend, Vec3d{0, upper ? 1.0 : -1.0, 0.3}, thickness, mesh);
      anchor(column, upper);
    }
  };
  if (shape.p.lashes > 0) {
    // The dark line along the rim, then hairs.
    std::vector<Section> line;
    for (int k = 0; k < count; ++k) {
      const Vec3d rim = skin.places[skin.at(l.upper_lid, l.eye_inner + k)];
      const double t = double(k) / (count - 1);
      const Vec3d away = normalised(rim - shape.eye);
      const double half = 0.015 + 0.075 * shape.p.lashes / 0.36 * smooth_step(0.0, 0.7, t);
      line.push_back({rim + away * 0.02 + Vec3d{0, 0.4 * half, 0}, Vec3d{0, half, 0}, away * 0.03});
    }
    constexpr int kAround = 4;
    add_tube(line, kAround, mesh);
    for (int k = 0; k < count; ++k) {
      columns.insert(columns.end(), kAround, l.eye_inner + k);
    }
    grow(true, shape.p.lashes * 1.25, 0.022, 2);
    grow(false, shape.p.lashes * 0.5, 0.013, 1);
  }
  for (int side : {1, -1}) {
    for (const int c : columns) {
      const int row = c > 0 ? l.upper_lid : l.lower_lid;
      anchors.push_back(skin.at(row, side * std::abs(c)));
    }
  }
  mesh.colours.assign(mesh.positions.size(), Vec3{0.02f, 0.012f, 0.01f});
  mesh.occlusion.assign(mesh.positions.size(), 0.8f);
  mesh.surface = SurfaceKind::hair;
  append_mirrored(mesh, 0, 0);
  return mesh;
}

}  // namespace animeme::head::detail
