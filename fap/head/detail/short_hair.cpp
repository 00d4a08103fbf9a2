// Short hair: a cap on the skull and the locks on it.
#include <array>
#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"
#include "fap/head/detail/scalp.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;
constexpr int kColumns = 120;
constexpr int kLockPlaces = 16;

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

const Cap& cap_of(const Shape& shape) {
  return shape.p.hair == HairStyle::fringe ? kFringe : kShortCut;
}

double edge_height(const Cap& cap, double angle) {
  std::size_t i = 0;
  while (i + 2 < cap.angles.size() && angle > cap.angles[i + 1]) ++i;
  return cap.heights[i] + (cap.heights[i + 1] - cap.heights[i]) *
                              smooth_step(cap.angles[i], cap.angles[i + 1], angle);
}

// 0..1, scattered over i.
double scatter(int i) { return double((std::uint32_t(i) * 2654435761u) >> 16 & 1023u) / 1023; }

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
    const int count = 11 - row;
    for (int i = 0; i < count; ++i) {
      const int seed = row * 16 + i;
      const double start = -0.78 + 1.56 * (i + 0.5) / count;
      const double sweep = start > kParting ? 0.55 : -0.75 - 0.3 * scatter(seed);
      const double root = edges[std::size_t((start / (2 * pi) + 1) * kColumns) % kColumns];
      const double lift = (row == 0 ? 1.25 : 0.5) * (start > kParting ? 0.45 : 1.0) *
                          (0.85 + 0.3 * scatter(seed + 5)) * std::cos(start * 0.9);
      const double reach = 0.62 + 0.1 * scatter(seed + 9);
      grow(
          scalp,
          [&](double t) {
            const double height = (row == 0 ? 0.15 : 0.75) +
                                  lift * std::sin(pi * std::pow(t, 0.62)) * (1 - 0.4 * t) +
                                  (row == 0 ? 0.75 : 0.2) * cap.top * smooth_step(0.0, 0.6, t);
            return Spot{root * (1 - 0.2 * row) * (1 - reach * t) + 0.02, start + sweep * t * t,
                        height};
          },
          1.0 - 0.08 * row, float(0.9 + 0.22 * scatter(seed + 3)), colour, mesh);
    }
  }
}

// From a whorl at the crown to all sides, in two layers; the ends in front are a fringe.
void add_mop(const Scalp& scalp, const Cap& cap, Vec3 colour, Mesh& mesh) {
  for (int layer = 0; layer < 2; ++layer) {
    const int count = layer == 0 ? 30 : 15;
    for (int i = 0; i < count; ++i) {
      const int seed = layer * 40 + i;
      const double start = 2 * pi * (i + 0.3 * scatter(seed)) / count;
      const double swirl = 0.5 + 0.2 * scatter(seed + 3);
      const double end = scalp.edge(start, [&](Vec3d p) {
        const double angle = std::atan2(std::abs(p.x), p.z);
        const double hang =
            1.7 * smooth_step(1.1, 0.5, angle) +
            (0.45 + 0.55 * scatter(seed + 7)) * smooth_step(0.12, 0.34, std::abs(angle - 1.62));
        return edge_height(cap, angle) - hang;
      });
      const double reach = layer == 0 ? end : end * (0.70 + 0.12 * scatter(seed + 1));
      grow(
          scalp,
          [&](double t) {
            const double full = cap.top + 0.05 + 0.5 * layer;
            const double lift = full + (0.45 - full + 0.5 * layer) * smooth_step(0.4, 0.95, t) -
                                (0.9 + 0.3 * layer) * smooth_step(0.14, 0.0, t);
            return Spot{0.1 + (reach - 0.1) * t, start - swirl * (1 - t) * (1 - t),
                        lift + 0.12 * smooth_step(0.85, 1.0, t)};
          },
          1.12 + 0.12 * std::cos(start) - 0.15 * layer, float(0.88 + 0.24 * scatter(seed + 11)),
          colour, mesh);
    }
  }
}

}  // namespace

double short_hair_field(const Shape& shape, Vec3d p) {
  const Cap& cap = cap_of(shape);
  const double skin = shape.skin(p);
  if (skin > 4) return skin - 2;  // far from any hair
  const double angle = std::atan2(std::abs(p.x), p.z);
  const double front = smooth_step(1.3, 0.6, angle);
  const double fringe = shape.p.hair == HairStyle::fringe ? 0.9 * front : 0;
  const double inside = (p.y - edge_height(cap, angle) + fringe) * 0.8;
  const double full = cap.sides + (cap.top - cap.sides) * smooth_step(2.5, 8.0, p.y);
  const double grown =
      full * smooth_step(-0.15, 0.7, inside) - 0.25 * smooth_step(0.0, -0.3, inside);
  // Nothing is left inside of the head below the edge.
  return smooth_max(skin - grown, -inside - 0.7, 0.2) * 0.8;
}

Mesh make_short_hair(const Shape& shape) {
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
  } else {
    add_quiff(scalp, cap, edges, colour, mesh);
  }
  // What lies below comes last: renderers need not paint it then.
  add_cap(scalp, edges, thickness, colour * 0.9f, mesh);
  mesh.surface = SurfaceKind::hair;
  return mesh;
}

}  // namespace animeme::head::detail
