#include <numbers>

#include "fap/head/detail/parts.h"
#include "fap/head/detail/tube.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;
constexpr Vec3 kEnamel{0.77f, 0.74f, 0.67f};
constexpr Vec3 kGum{0.55f, 0.17f, 0.16f};
constexpr Vec3 kTongue{0.60f, 0.19f, 0.18f};

// The arch of the teeth seen from above: flat before, open to the back; its ends rise.
struct Arch {
  double half_width, depth, front, height, rise;
  Vec3d place(double t) const {  // t -1..1 from the right end to the left one
    const double a = t * pi / 2;
    const double aside = std::sin(a);
    return {half_width * aside, height + rise * aside * aside,
            front - depth * std::pow(1 - std::cos(a), 1.3)};
  }
  Vec3d outwards(double t) const {
    const Vec3d along = place(t + 1e-3) - place(t - 1e-3);
    return normalised(Vec3d{-along.z, 0, along.x});
  }
};

struct Tooth {
  Vec3d place, along, out;
  double half_width, half_height, half_depth, down;
};

// A rounded box; flatter at the biting edge.
void add_tooth(const Tooth& tooth, float light, Mesh& mesh) {
  constexpr int kRings = 7;
  constexpr int kAround = 12;
  const auto base = std::uint32_t(mesh.positions.size());
  const auto power = [](double v, double e) { return std::copysign(std::pow(std::abs(v), e), v); };
  const auto add = [&](double polar, double a) {
    const double r = power(std::sin(polar), 0.5);
    const Vec3d p = tooth.along * (tooth.half_width * r * power(std::cos(a), 0.6)) +
                    tooth.out * (tooth.half_depth * r * power(std::sin(a), 0.7)) +
                    Vec3d{0, -tooth.down * tooth.half_height * power(std::cos(polar), 0.65), 0};
    mesh.positions.push_back(Vec3(tooth.place + p));
    const float root = float(smooth_step(0.2, -1.0, std::cos(polar)));
    mesh.colours.push_back(mix(kEnamel, kEnamel * Vec3{0.92f, 0.82f, 0.7f}, root));
    mesh.occlusion.push_back(light * (0.75f + 0.25f * (1 - root)));
  };
  add(0, 0);
  for (int ring = 1; ring < kRings; ++ring) {
    for (int k = 0; k < kAround; ++k) add(pi * ring / kRings, 2 * pi * k / kAround);
  }
  add(pi, 0);
  const auto at = [base](int ring, int k) {
    return base + 1 + std::uint32_t((ring - 1) * kAround + k % kAround);
  };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  const bool flip = tooth.down > 0;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (flip) std::swap(b, c);
    mesh.triangles.push_back({a, b, c});
  };
  for (int k = 0; k < kAround; ++k) {
    triangle(base, at(1, k + 1), at(1, k));
    for (int ring = 1; ring + 1 < kRings; ++ring) {
      triangle(at(ring, k), at(ring, k + 1), at(ring + 1, k + 1));
      triangle(at(ring, k), at(ring + 1, k + 1), at(ring + 1, k));
    }
    triangle(at(kRings - 1, k), at(kRings - 1, k + 1), last);
  }
}

// Gums: a tube along the arch.
void add_gum(const Arch& arch, double offset, double height, Mesh& mesh) {
  constexpr int kSections = 32;
  constexpr int kAround = 10;
  const auto base = std::uint32_t(mesh.positions.size());
  for (int i = 0; i < kSections; ++i) {
    const double t = -1 + 2.0 * i / (kSections - 1);
    const Vec3d out = arch.outwards(t);
    const Vec3d place = arch.place(t) + Vec3d{0, offset, 0} - out * 0.12;
    const bool end = i == 0 || i == kSections - 1;
    for (int k = 0; k < kAround; ++k) {
      const double a = 2 * pi * k / kAround;
      const double s = end ? 0.3 : 1.0;
      mesh.positions.push_back(
          Vec3(place + out * (0.30 * s * std::cos(a)) + Vec3d{0, height * s * std::sin(a), 0}));
      mesh.colours.push_back(kGum);
      mesh.occlusion.push_back(float(0.75 - 0.5 * t * t));
    }
  }
  join_rings(base, kSections, kAround, mesh);
}

}  // namespace

Mesh make_teeth(const Shape& shape, bool upper) {
  const double size = shape.p.mouth_width / 2.35;
  const double front = shape.front(0, -shape.p.mouth_drop).z - 0.54;
  // Upper teeth are a little before the lower ones and cover their edges.
  const Arch arch{shape.p.mouth_width * (upper ? 1.09 : 1.05), 3.0, front - (upper ? 0 : 0.13),
                  -shape.p.mouth_drop - 0.19, upper ? 0.16 : 0.12};
  const double widths[] = {0.45, 0.36, 0.40, 0.37, 0.37, 0.48, 0.48};  // from the middle outwards
  const double heights[] = {1.0, 0.9, 1.0, 0.88, 0.84, 0.8, 0.75};
  Mesh mesh;
  mesh.surface = SurfaceKind::teeth;
  double t = 0;
  for (int i = 0; i < 7; ++i) {
    const double scale = upper ? 1.0 : (i < 2 ? 0.76 : 0.97);
    const double width = widths[i] * scale * size;
    // Half of the tooth along the arch, in t.
    const double speed = length(arch.place(t + 0.04) - arch.place(t)) / 0.04;
    const double middle = t + width / speed;
    t = middle + width / speed;
    const double half_height = (upper ? 0.56 : 0.46) * heights[upper ? i : 0] * (i > 3 ? 0.9 : 1.0);
    for (const double side : {1.0, -1.0}) {
      const Vec3d out = arch.outwards(side * middle);
      const Vec3d along = normalised(cross(Vec3d{0, 1, 0}, out));
      Tooth tooth{arch.place(side * middle), along, out, width * 1.03, half_height, 0.19,
                  upper ? 1.0 : -1.0};
      // Edges of shorter teeth are a little higher.
      tooth.place.y += upper ? half_height + 0.5 * (0.56 - half_height) : -half_height;
      add_tooth(tooth, float(1.0 - 0.1 * i), mesh);
    }
  }
  add_gum(arch, upper ? 1.2 : -1.0, 0.42, mesh);
  return mesh;
}

Mesh make_tongue(const Shape& shape) {
  const double tip = shape.front(0, -shape.p.mouth_drop).z - 1.0;
  const double wide = shape.p.mouth_width * 0.60;
  const double size = std::min(shape.p.mouth_width / 2.05, 1.0);
  const double tip_height = -0.52;  // against the lips
  const auto bent = [](double v, double e) { return std::copysign(std::pow(std::abs(v), e), v); };
  Mesh mesh;
  mesh.surface = SurfaceKind::wet;
  for (int row = 0; row < kTongueRows; ++row) {
    // 0 root, 1 in the tip, where rows are dense: it is round from above and from the side.
    const double t = std::sin(pi / 2 * row / kTongueRows);
    const double narrow = std::sqrt(1 - std::pow(smooth_step(0.3, 1.35, t), 2)) *
                          std::sqrt(1 - std::pow(std::max((t - 0.8) / 0.2, 0.0), 2));
    const double blunt = std::sqrt(1 - std::pow(std::max((t - 0.74) / 0.26, 0.0), 2));
    const double back = -0.40 + 0.66 * smooth_step(0.0, 0.5, t) - 0.64 * smooth_step(0.5, 1.0, t);
    const double below = -1.25 + 0.48 * smooth_step(0.4, 0.9, t);
    const double top = tip_height + (back - tip_height) * size * blunt;
    const double bottom = tip_height + (below - tip_height) * size * blunt;
    const double half = wide * narrow;
    for (int k = 0; k < kTongueAround; ++k) {
      const double a = 2 * pi * k / kTongueAround;  // from the top
      const double groove = std::exp(-std::pow(std::sin(a) / 0.38, 2)) *
                            (std::cos(a) > 0 ? 1.0 : 0.0) * blunt * (1 - 0.5 * t);
      const double y =
          (top + bottom) / 2 + (top - bottom) / 2 * bent(std::cos(a), 0.68 + 0.3 * t * t);
      mesh.positions.push_back(
          Vec3(Vec3d{half * bent(std::sin(a), 0.95), y - shape.p.mouth_drop - 0.26 * size * groove,
                     tip - 4.3 + 4.3 * t}));
      mesh.colours.push_back(kTongue * float(0.75 + 0.35 * t));
      mesh.occlusion.push_back(float((0.18 + 0.57 * t) * (1 - 0.3 * groove)));
    }
  }
  mesh.positions.push_back(Vec3(Vec3d{0, tip_height - shape.p.mouth_drop, tip}));
  mesh.colours.push_back(kTongue * 1.1f);
  mesh.occlusion.push_back(0.75f);
  const auto at = [](int row, int k) {
    return std::uint32_t(row * kTongueAround + k % kTongueAround);
  };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  for (int k = 0; k < kTongueAround; ++k) {
    for (int row = 0; row + 1 < kTongueRows; ++row) {
      mesh.triangles.push_back({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      mesh.triangles.push_back({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
    }
    mesh.triangles.push_back({at(kTongueRows - 1, k), last, at(kTongueRows - 1, k + 1)});
    if (k > 0 && k + 1 < kTongueAround)
      mesh.triangles.push_back({at(0, 0), at(0, k), at(0, k + 1)});
  }
  return mesh;
}

}  // namespace animeme::head::detail
