// Short hair: a cap on the skull and the locks on it.
#include <array>
#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"
#include "fap/head/detail/scalp.h"
#include "fap/head/detail/tube.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;
constexpr int kColumns = 120;
constexpr int kLockPlaces = 11;

// The lower edge of the hair runs around the head at heights over the angle from the front.
struct Cap {
  std::array<double, 12> angles;  // rad, 0 = front, rising to pi
  std::array<double, 12> heights;
  double sides, top;  // thickness, cm
  double round;       // from the edge to full thickness, share of the way to the crown
  double strands;     // depth of the grooves
  double tilt;        // of the crown, rad
};

constexpr Cap kShortCut{{0, 0.40, 0.72, 0.92, 1.06, 1.13, 1.36, 1.45, 1.62, 1.80, 2.00, 3.15},
                        {6.5, 6.3, 5.6, 3.6, 1.2, -0.6, -0.8, 1.3, 2.2, 1.4, -2.2, -5.0},
                        0.38,
                        1.0,
                        0.16,
                        0.10,
                        0.35};
constexpr Cap kFringe{{0, 0.40, 0.70, 0.95, 1.10, 1.18, 1.32, 1.42, 1.62, 1.78, 1.95, 3.15},
                      {5.6, 5.5, 4.6, 2.6, 0.4, -0.6, -0.6, 1.0, 1.9, 1.2, -2.2, -4.0},
                      0.55,
                      0.9,
                      0.14,
                      0.08,
                      0.28};

constexpr Cap kBun{{0, 0.40, 0.72, 0.92, 1.06, 1.13, 1.36, 1.45, 1.62, 1.80, 2.00, 3.15},
                   {6.6, 6.3, 5.2, 3.2, 1.0, -0.4, -0.6, 1.2, 2.2, 1.2, -2.4, -4.6},
                   0.42,
                   0.62,
                   0.12,
                   0.08,
                   0.9};
constexpr Cap kCurly{{0, 0.40, 0.72, 0.92, 1.06, 1.13, 1.36, 1.45, 1.62, 1.80, 2.00, 3.15},
                     {6.0, 5.8, 4.8, 3.0, 0.8, -0.8, -1.2, 0.9, 1.6, 0.6, -3.2, -6.0},
                     1.9,
                     2.6,
                     0.2,
                     0,
                     0.2};
constexpr Vec3d kKnot{0, 4.4, -10.5};  // of a bun
constexpr double kKnotSize = 2.6;

const Cap& cap_of(const Shape& shape) {
  switch (shape.p.hair) {
    case HairStyle::fringe:
      return kFringe;
    case HairStyle::bun:
      return kBun;
    case HairStyle::curly:
      return kCurly;
    default:
      return kShortCut;
  }
}

double edge_height(const Cap& cap, double angle) {
  std::size_t i = 0;
  while (i + 2 < cap.angles.size() && angle > cap.angles[i + 1]) ++i;
  return cap.heights[i] + (cap.heights[i + 1] - cap.heights[i]) *
                              smooth_step(cap.angles[i], cap.angles[i + 1], angle);
}

// Where a lock is at t, 0 at its root and 1 at its tip.
struct Spot {
  double theta, phi, height;
};

template <class Path>
void grow(const Scalp& scalp, const Path& path, double width, float tint, Vec3 colour, Mesh& mesh) {
  Lock lock;
  lock.width = width;
  lock.tint = tint;
  for (int i = 0; i < kLockPlaces; ++i) {
    const Spot s = path(double(i) / (kLockPlaces - 1));
    lock.places.push_back(scalp.place(s.theta, s.phi, s.height));
    lock.outwards.push_back(scalp.direction(s.theta, s.phi));
  }
  add_lock(lock, colour, mesh);
}

// Combed back and to the right from a parting on the left, high in front.
void add_quiff(const Scalp& scalp, const Cap& cap, const std::vector<double>& edges, Vec3 colour,
               Mesh& mesh) {
  constexpr double kParting = 0.34;
  for (int row = 2; row >= 0; --row) {
    const int count = 24 - 2 * row;
    for (int i = 0; i < count; ++i) {
      const int seed = row * 32 + i;
      const double start = -0.78 + 1.56 * (i + 0.5) / count;
      const double sweep = start > kParting ? 0.55 : -0.75 - 0.3 * scattered(seed);
      const double root = edges[std::size_t((start / (2 * pi) + 1) * kColumns) % kColumns];
      const double lift = (row == 0 ? 1.25 : 0.5) * (start > kParting ? 0.45 : 1.0) *
                          (0.85 + 0.3 * scattered(seed + 5)) * std::cos(start * 0.9);
      const double reach = 0.62 + 0.1 * scattered(seed + 9);
      grow(
          scalp,
          [&](double t) {
            const double height = (row == 0 ? 0.15 : 0.75) +
                                  lift * std::sin(pi * std::pow(t, 0.62)) * (1 - 0.4 * t) +
                                  (row == 0 ? 0.75 : 0.2) * cap.top * smooth_step(0.0, 0.6, t);
            return Spot{root * (1 - 0.2 * row) * (1 - reach * t) + 0.02, start + sweep * t * t,
                        height};
          },
          0.5 - 0.04 * row, float(0.84 + 0.32 * scattered(seed + 3)), colour, mesh);
    }
  }
}

// From a whorl at the crown to all sides, in two layers; the ends in front are a fringe.
void add_mop(const Scalp& scalp, const Cap& cap, Vec3 colour, Mesh& mesh) {
  for (int layer = 0; layer < 2; ++layer) {
    const int count = layer == 0 ? 64 : 40;
    for (int i = 0; i < count; ++i) {
      const int seed = layer * 80 + i;
      const double start = 2 * pi * (i + 0.3 * scattered(seed)) / count;
      const double swirl = 0.5 + 0.2 * scattered(seed + 3);
      const double end = scalp.edge(start, [&](Vec3d p) {
        const double angle = std::atan2(std::abs(p.x), p.z);
        const double hang =
            0.75 * smooth_step(1.1, 0.5, angle) +  // raised brows stay below

            (0.45 + 0.55 * scattered(seed + 7)) * smooth_step(0.12, 0.34, std::abs(angle - 1.62));
        return edge_height(cap, angle) - hang;
      });
      const double reach = layer == 0 ? end : end * (0.70 + 0.12 * scattered(seed + 1));
      grow(
          scalp,
          [&](double t) {
            const double full = cap.top + 0.05 + 0.5 * layer;
            const double lift = full + (0.45 - full + 0.5 * layer) * smooth_step(0.4, 0.95, t) -
                                (0.9 + 0.3 * layer) * smooth_step(0.14, 0.0, t);
            return Spot{0.1 + (reach - 0.1) * t, start - swirl * (1 - t) * (1 - t),
                        lift + 0.12 * smooth_step(0.85, 1.0, t)};
          },
          0.62 + 0.06 * std::cos(start) - 0.08 * layer, float(0.82 + 0.34 * scattered(seed + 11)),
          colour, mesh);
    }
  }
}

// From the edge all around to the knot behind, and the knot, wound of locks.
void add_swept(const Shape& shape, const Scalp& scalp, const std::vector<double>& edges,
               Vec3 colour, Mesh& mesh) {
  constexpr int kCount = 96;
  constexpr Vec3d kWithin{0, 3.2, -0.6};
  const Vec3d to_knot = normalised(kKnot - kWithin);
  for (int i = 0; i < kCount; ++i) {
    const double phi = 2 * pi * (i + 0.4 * scattered(i)) / kCount;
    const double edge = edges[std::size_t(phi / (2 * pi) * kColumns) % kColumns];
    const Vec3d from = normalised(scalp.direction(edge * 0.99, phi));
    if (dot(from, to_knot) > 0.86) continue;
    Lock lock;
    lock.width = 0.5 + 0.2 * scattered(i + 40);
    lock.tint = float(0.84 + 0.3 * scattered(i + 80));
    const double above = 0.34 + 0.14 * scattered(i + 120);
    for (int k = 0; k < kLockPlaces; ++k) {
      const double t = double(k) / (kLockPlaces - 1);
      const Vec3d away = normalised(from * (1 - t) + to_knot * t + Vec3d{0, 0.35 * t * (1 - t), 0});
      const double height = above * smooth_step(0.0, 0.2, t) - 0.12 * smooth_step(0.15, 0.0, t) +
                            0.25 * smooth_step(0.8, 1.0, t);
      lock.places.push_back(outer_hit(shape.skin, kWithin, away, 16) + away * height);
      lock.outwards.push_back(away);
    }
    add_lock(lock, colour, mesh);
  }
  constexpr int kWindings = 13;
  const Vec3d side{1, 0, 0};
  const Vec3d up = normalised(cross(to_knot, side));
  for (int i = 0; i < kWindings; ++i) {
    Lock lock;
    const double polar = 0.16 + 1.5 * i / (kWindings - 1);
    lock.width = 0.42;
    lock.tint = float(0.86 + 0.28 * scattered(i + 300));
    for (int k = 0; k <= 2 * kLockPlaces; ++k) {
      const double a = 2.15 * pi * k / (2 * kLockPlaces) + i;
      const Vec3d out =
          to_knot * std::cos(polar) + (side * std::cos(a) + up * std::sin(a)) * std::sin(polar);
      lock.places.push_back(kKnot + out * (kKnotSize * (0.86 + 0.1 * k / (2.0 * kLockPlaces))));
      lock.outwards.push_back(out);
    }
    add_lock(lock, colour, mesh);
  }
}

double bumps(Vec3d p) {
  return std::sin(p.x * 3.1 + 0.7 * std::sin(p.y * 2.3)) * std::sin(p.y * 3.3 + 0.4) *
             std::sin(p.z * 2.9 + 1.1) +
         0.5 * std::sin(p.x * 5.7 + 1) * std::sin(p.y * 6.1 + p.z) * std::sin(p.z * 5.3);
}

Mesh make_curls(const Shape& shape) {
  const auto field = [&shape](Vec3d p) { return short_hair_field(shape, p); };
  Mesh mesh =
      surface_nets(field, {-12, -8.5, -13.5}, {12, 15.5, 12}, 0.5 / std::sqrt(shape.p.density));
  const Vec3 colour = linear_colour(shape.p.hair_colour);
  for (const Vec3& v : mesh.positions) {
    const auto bump = float(bumps(Vec3d(v)));
    mesh.colours.push_back(colour * (1.0f - 0.35f * bump));
    mesh.occlusion.push_back(std::clamp(0.85f - 0.35f * bump, 0.3f, 1.0f));
  }
  mesh.surface = SurfaceKind::hair;
  return mesh;
}

}  // namespace

void add_glasses(const Shape& shape, Mesh& mesh) {
  if (shape.p.glasses == Glasses::none) return;
  constexpr int kAround = 6, kRim = 40;
  constexpr double kThick = 0.11;
  const std::size_t first = mesh.positions.size();
  const std::size_t first_triangle = mesh.triangles.size();
  const bool square = shape.p.glasses == Glasses::square;
  const double wide = shape.p.eye_distance - 0.55;
  const double high = square ? wide * 0.72 : wide * 0.92;
  const double plane = std::max(shape.front(0, 0.1).z + 0.25, shape.eye.z + shape.lid + 0.75);
  const auto on_plane = [&](double x, double y) {
    return Vec3d{x, y, plane - 0.022 * x * x - 0.03 * (y + 1)};
  };
  const auto rim = [&](double a) {
    const auto bent = [square](double v) {
      return square ? std::copysign(std::pow(std::abs(v), 0.45), v) : v;
    };
    return on_plane(shape.eye.x + wide * bent(std::cos(a)), -0.25 + high * bent(std::sin(a)));
  };
  const auto tube = [&](const std::vector<Vec3d>& line, Vec3d outwards) {
    std::vector<Section> sections;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vec3d along = normalised(line[std::min(i + 1, line.size() - 1)] - line[i ? i - 1 : 0]);
      const Vec3d up = normalised(cross(outwards, along));
      sections.push_back({line[i], up * kThick, normalised(cross(along, up)) * kThick});
    }
    add_tube(sections, kAround, mesh);
  };
  std::vector<Vec3d> line;
  for (int i = 0; i <= kRim; ++i) line.push_back(rim(2 * pi * i / kRim));
  tube(line, {0, 0, 1});
  // From the rim to above the ear, and down behind it.
  const Vec3d hinge = rim(0.35);
  const Vec3d over = shape.ear + Vec3d{0, 1.75 * shape.p.ear, -0.3};
  line = {hinge};
  for (int i = 1; i <= 8; ++i) {
    const Vec3d p = mix(hinge, over, 0.04 + 0.12 * i);
    const Vec3d skin = outer_hit(shape.skin, {0, p.y, p.z}, {1, 0, 0}, 14);
    line.push_back({std::max(p.x, skin.x + 0.22), p.y, p.z});
  }
  line.push_back(line.back() + Vec3d{0.05, -0.25, -0.9});
  line.push_back(line.back() + Vec3d{-0.1, -1.3, -0.8});
  tube(line, {1, 0, 0});
  // The left half of the bridge.
  line.clear();
  const double inner = shape.eye.x - wide;
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    line.push_back(on_plane(inner * t, 0.55 - 0.3 * t * t) + Vec3d{0, 0, 0.12 * (1 - t)});
  }
  tube(line, {0, 0, 1});
  mesh.colours.resize(mesh.positions.size(), Vec3{0.012f, 0.010f, 0.010f});
  mesh.occlusion.resize(mesh.positions.size(), 1.0f);
  append_mirrored(mesh, first, first_triangle);
}

double short_hair_field(const Shape& shape, Vec3d p) {
  if (shape.p.hair == HairStyle::bald) return 10;
  const Cap& cap = cap_of(shape);
  const double skin = shape.skin(p);
  if (skin > 4) return skin - 2;  // far from any hair
  const double angle = std::atan2(std::abs(p.x), p.z);
  const double front = smooth_step(1.3, 0.6, angle);
  const double fringe = shape.p.hair == HairStyle::fringe ? 0.9 * front : 0;
  const double inside = (p.y - edge_height(cap, angle) + fringe) * 0.8;
  const double full = cap.sides + (cap.top - cap.sides) * smooth_step(2.5, 8.0, p.y);
  const bool curly = shape.p.hair == HairStyle::curly;
  const double grown = full * smooth_step(-0.15, curly ? 2.2 : 0.7, inside) -
                       0.25 * smooth_step(0.0, -0.3, inside) - (curly ? 0.16 * bumps(p) : 0);
  // Nothing is left inside of the head below the edge.
  const double hair = smooth_max(skin - grown, -inside - 0.7, 0.2) * 0.8;
  if (shape.p.hair != HairStyle::bun) return hair;
  return std::min(hair, length(p - kKnot) - kKnotSize);
}

Mesh make_short_hair(const Shape& shape) {
  if (shape.p.hair == HairStyle::bald) return {.surface = SurfaceKind::hair};
  if (shape.p.hair == HairStyle::curly) return make_curls(shape);
  const Cap& cap = cap_of(shape);
  const Scalp scalp(shape, cap.tilt);
  std::vector<double> edges;
  for (int i = 0; i < kColumns; ++i) {
    edges.push_back(scalp.edge(2 * pi * i / kColumns, [&](Vec3d p) {
      return edge_height(cap, std::atan2(std::abs(p.x), p.z));
    }));
  }
  const auto thickness = [&cap](double inside, double phi) {
    const double full = cap.sides + (cap.top - cap.sides) * smooth_step(0.15, 0.6, inside);
    const double from_edge = std::min(inside / cap.round, 1.0);
    const double round = std::sqrt(std::max(1 - (1 - from_edge) * (1 - from_edge), 0.0));
    const double wave = 0.5 + 0.5 * std::sin(phi * 20 + 1.5 * std::sin(inside * 5));
    return full * round - cap.strands * wave * round * smooth_step(1.0, 0.8, inside);
  };
  const Vec3 colour = linear_colour(shape.p.hair_colour);
  Mesh mesh;
  if (shape.p.hair == HairStyle::fringe) {
    add_mop(scalp, cap, colour, mesh);
  } else if (shape.p.hair == HairStyle::bun) {
    add_swept(shape, scalp, edges, colour, mesh);
  } else {
    add_quiff(scalp, cap, edges, colour, mesh);
  }
  // What lies below comes last: renderers need not paint it then.
  add_cap(scalp, edges, thickness, colour * 0.9f, mesh);
  mesh.surface = SurfaceKind::hair;
  return mesh;
}

}  // namespace animeme::head::detail
