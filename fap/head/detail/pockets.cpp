#include "fap/head/detail/grid.h"

#include <array>
#include <functional>
#include <numbers>

namespace animeme::head::detail {
namespace {

struct LoopVertex {
  std::uint32_t id;
  int column;
  bool upper;
};

// Round a slit: the upper row with rising columns, then the lower one back. The corners are once.
std::vector<LoopVertex> loop_around(const Skin& skin, int upper_row, int first, int last) {
  std::vector<LoopVertex> loop;
  for (int c = first; c <= last; ++c) loop.push_back({skin.at(upper_row, c), c, true});
  for (int c = last - 1; c > first; --c) loop.push_back({skin.at(upper_row + 1, c), c, false});
  return loop;
}

using Place = std::function<Vec3d(const LoopVertex&, int ring)>;

// `rings` loops further inside, closed by a vertex in the middle.
void add_pocket(Skin& skin, const std::vector<LoopVertex>& loop, int rings, const Place& place,
                Vec3d middle) {
  std::vector<std::uint32_t> outer;
  for (const LoopVertex& v : loop) outer.push_back(v.id);
  const std::size_t n = loop.size();
  for (int ring = 1; ring <= rings; ++ring) {
    std::vector<std::uint32_t> inner;
    for (const LoopVertex& v : loop) {
      inner.push_back(std::uint32_t(skin.places.size()));
      skin.places.push_back(place(v, ring));
    }
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      // The diagonals of the right side are the mirror images of those of the left one.
      if (std::abs(loop[next].column) > std::abs(loop[k].column)) {
        skin.mesh.triangles.push_back({outer[k], inner[k], inner[next]});
        skin.mesh.triangles.push_back({outer[k], inner[next], outer[next]});
      } else {
        skin.mesh.triangles.push_back({outer[k], inner[k], outer[next]});
        skin.mesh.triangles.push_back({inner[k], inner[next], outer[next]});
      }
    }
    outer = inner;
  }
  const auto centre = std::uint32_t(skin.places.size());
  skin.places.push_back(middle);
  for (std::size_t k = 0; k < n; ++k) {
    skin.mesh.triangles.push_back({outer[k], centre, outer[(k + 1) % n]});
  }
}

// The cavity: half width, half heights above and below, depth behind the lips in the middle and
// more at the sides.
struct Ring {
  double width, above, below, depth, side_depth, jaw;
};
constexpr std::array<Ring, 8> kMouthRings = {{{0.985, 0.10, 0.10, 0.18, 0.05, 0},
                                              {0.98, 0.42, 0.42, 0.30, 0.15, 0},
                                              {1.04, 1.05, 1.05, 0.45, 0.80, 0.15},
                                              {1.18, 1.45, 1.50, 0.95, 1.30, 0.6},
                                              {1.30, 1.50, 1.65, 2.00, 1.50, 0.8},
                                              {1.36, 1.45, 1.70, 3.30, 1.40, 0.8},
                                              {1.20, 1.30, 1.55, 4.50, 0.90, 0.7},
                                              {0.60, 0.80, 0.95, 5.30, 0.40, 0.5}}};
constexpr double kMouthDepth = 5.5;

}  // namespace

void add_mouth_bag(const Shape& shape, Skin& skin) {
  const Layout& l = skin.layout;
  const int corner = l.mouth_corner;
  const std::vector<LoopVertex> loop = loop_around(skin, l.upper_contact, -corner, corner);
  const double front = skin.places[skin.at(l.upper_contact, 0)].z;
  const double height = -shape.p.mouth_drop;
  const double wide = shape.p.mouth_width;
  const std::size_t first = skin.places.size();
  const auto place = [&](const LoopVertex& v, int ring) {
    const Ring& r = kMouthRings[std::size_t(ring - 1)];
    const double s = double(v.column) / corner;
    const double angle = s * std::numbers::pi / 2;
    const Vec3d lip = skin.places[v.id];
    const double deep = smooth_step(2.0, 4.0, double(ring));  // 0: along the lips, 1: ellipse
    const double along = std::sqrt(std::max(1 - s * s, 0.0));
    const double rise = v.upper ? r.above : -r.below;
    const Vec3d near{lip.x * r.width, lip.y + rise * along,
                     lip.z - r.depth - r.side_depth * s * s * 0.3};
    const Vec3d far{std::sin(angle) * wide * r.width, height + rise * std::cos(angle),
                    front - r.depth - r.side_depth * s * s};
    return mix(near, far, deep);
  };
  add_pocket(skin, loop, int(kMouthRings.size()), place, {0, height, front - kMouthDepth});
  skin.seams.jaw_weights.assign(skin.places.size(), 0);
  for (std::size_t ring = 0; ring < kMouthRings.size(); ++ring) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const double s = double(loop[k].column) / corner;
      const double below = loop[k].upper ? 0 : std::cos(s * std::numbers::pi / 2);
      skin.seams.jaw_weights[first + ring * loop.size() + k] = float(kMouthRings[ring].jaw * below);
    }
  }
  for (int c = -corner + 1; c < corner; ++c) {
    skin.seams.lips.push_back({skin.at(l.upper_contact, c), skin.at(l.lower_contact, c)});
  }
}

void add_eye_pocket(const Shape& shape, Skin& skin, int side) {
  const Layout& l = skin.layout;
  const int first = side > 0 ? l.eye_inner : -l.eye_outer;
  const int last = side > 0 ? l.eye_outer : -l.eye_inner;
  const std::vector<LoopVertex> loop = loop_around(skin, l.upper_lid, first, last);
  const Vec3d eye{shape.eye.x * side, shape.eye.y, shape.eye.z};
  const auto start = std::uint32_t(skin.places.size());
  const auto place = [&](const LoopVertex& v, int ring) {
    const Vec3d away = normalised(skin.places[v.id] - eye);
    const double radius[] = {shape.p.eye_radius + 0.02, shape.p.eye_radius * 0.75,
                             shape.p.eye_radius * 0.4};
    return eye + away * radius[ring - 1];
  };
  add_pocket(skin, loop, 3, place, eye);
  const std::size_t which = side > 0 ? 0 : 1;
  auto& pairs = skin.seams.lids[which];
  for (int c = first + 1; c < last; ++c) {
    pairs.push_back({skin.at(l.upper_lid, c), skin.at(l.lower_lid, c)});
  }
  // The inner edges of the rims meet as well.
  const auto width = std::uint32_t(last - first);
  for (std::uint32_t k = 1; k < width; ++k) {
    pairs.push_back({start + k, start + 2 * width - k});
  }
}

}  // namespace animeme::head::detail
