#include <numbers>

#include "fap/head/detail/paint.h"
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
  mesh.material = Material::teeth;
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
  const double front = shape.front(0, -shape.p.mouth_drop).z - 1.0;
  const double wide = shape.p.mouth_width * 0.60;
  Mesh mesh;
  mesh.material = Material::wet;
  for (int row = 0; row < kTongueRows; ++row) {
    const double t = double(row) / (kTongueRows - 1);  // 0 root, 1 near the tip
    const double taper = std::sqrt(std::max(1 - std::pow(t, 3.2) * 0.93, 0.0));
    const double half = wide * taper;
    const double thick = (0.62 - 0.22 * t) * std::max(taper, 0.62);  // the tip is a finger, no leaf
    const double z = front - 4.3 + 4.25 * t;
    const double y =
        -shape.p.mouth_drop - 0.72 + 0.38 * std::sin(pi * std::min(t * 1.1, 1.0)) + 0.22 * t * t;
    for (int k = 0; k < kTongueAround; ++k) {
      const double a = 2 * pi * k / kTongueAround;  // from the top
      const double groove = -0.14 * std::exp(-std::pow(std::sin(a) / 0.35, 2)) *
                            (std::cos(a) > 0 ? 1.0 : 0.0) * (1 - 0.6 * t);
      mesh.positions.push_back(
          Vec3(Vec3d{half * std::sin(a), y + thick * std::cos(a) + groove, z}));
      mesh.colours.push_back(kTongue * float(0.75 + 0.35 * t));
      mesh.occlusion.push_back(float(0.18 + 0.55 * t));
    }
  }
  mesh.positions.push_back(Vec3(Vec3d{0, -shape.p.mouth_drop - 0.52, front}));
  mesh.colours.push_back(kTongue * 1.1f);
  mesh.occlusion.push_back(0.75f);
  const auto at = [](int row, int k) {
    return std::uint32_t(row * kTongueAround + k % kTongueAround);
  };
  const auto tip = std::uint32_t(mesh.positions.size() - 1);
  for (int k = 0; k < kTongueAround; ++k) {
    for (int row = 0; row + 1 < kTongueRows; ++row) {
      mesh.triangles.push_back({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      mesh.triangles.push_back({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
    }
    mesh.triangles.push_back({at(kTongueRows - 1, k), tip, at(kTongueRows - 1, k + 1)});
    if (k > 0 && k + 1 < kTongueAround)
      mesh.triangles.push_back({at(0, 0), at(0, k), at(0, k + 1)});
  }
  return mesh;
}

}  // namespace animeme::head::detail
