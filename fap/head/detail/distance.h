// Signed distance fields: forms as smooth unions of simple bodies. Distances are exact near the
// surface of balls and capsules and close to it for ellipsoids, which is all that is needed here.
#pragma once

#include <array>
#include <vector>

#include "fap/head/vector.h"

namespace animeme::head::detail {

double ellipsoid(Vec3d p, Vec3d radii);
/// A ball at a of radius ra, one at b of radius rb, and the cone between.
double cone(Vec3d p, Vec3d a, Vec3d b, double ra, double rb);
/// Least of a and b, rounded where they differ by less than k.
double smooth_min(double a, double b, double k);
double smooth_max(double a, double b, double k);

enum class Body : unsigned char { ellipsoid, cone };
enum class Join : unsigned char { add, subtract };

/// One body of a form. An ellipsoid has its centre in `a` and its radii in `b`.
struct Primitive {
  Body body;
  Vec3d a;
  Vec3d b;
  double ra = 0;
  double rb = 0;
  double blend = 0;  ///< see smooth_min
  Join join = Join::add;
};

/// Left and right alike: p.x counts as |p.x|.
class Form {
 public:
  void ball(Vec3d centre, Vec3d radii, double blend) {
    add({Body::ellipsoid, centre, radii, 0, 0, blend});
  }
  void hollow(Vec3d centre, Vec3d radii, double blend) {
    add({Body::ellipsoid, centre, radii, 0, 0, blend, Join::subtract});
  }
  void limb(Vec3d a, Vec3d b, double ra, double rb, double blend) {
    add({Body::cone, a, b, ra, rb, blend});
  }
  double operator()(Vec3d p) const;

 private:
  static constexpr std::size_t kMostBodies = 24;

  void add(const Primitive& body);

  // A body that is not needed is known by a cheap lower bound of its distance. A cone lies in its
  // ball. For an ellipsoid let k0 and k1 be the lengths of ellipsoid(): k1 <= k0 / its least
  // radius, so from k0 >= 1 on the distance is not below (k0 - 1) least radius.
  struct Part {
    bool is_ball;
    double sign, blend;          // 1 adds, -1 takes away
    double start, slope, least;  // of the bound: in units of places_, by the distance asked for
    double radius;               // ellipsoid: the least one
    Vec3d a, ab;                 // cone
    double inverse_square, ra, widening;
  };
  // Middles, and the inverse of the radii of ellipsoids: a number of all bodies side by side.
  std::array<std::array<double, kMostBodies>, 6> places_{};
  std::vector<Part> parts_;
};

/// Direction away from the surface, by differences.
template <class Field>
Vec3d gradient(const Field& field, Vec3d p, double step = 0.02) {
  const double h = step;
  return normalised(Vec3d{field(p + Vec3d{h, 0, 0}) - field(p - Vec3d{h, 0, 0}),
                          field(p + Vec3d{0, h, 0}) - field(p - Vec3d{0, h, 0}),
                          field(p + Vec3d{0, 0, h}) - field(p - Vec3d{0, 0, h})});
}

/// Where a ray from inside leaves the field for good: marched from `far` back to `origin`.
template <class Field>
Vec3d outer_hit(const Field& field, Vec3d origin, Vec3d direction, double far) {
  double t = far;
  for (int i = 0; i < 96 && t > 0; ++i) {
    const double d = field(origin + direction * t);
    if (d < 1e-4) break;
    t -= d * 0.8;
  }
  return origin + direction * std::max(t, 0.0);
}

/// Moves p to the surface along the gradient.
template <class Field>
Vec3d project(const Field& field, Vec3d p, int steps = 3) {
  constexpr double h = 0.02;
  for (int i = 0; i < steps; ++i) {
    const double d = field(p);
    p -= normalised(Vec3d{field(p + Vec3d{h, 0, 0}) - d, field(p + Vec3d{0, h, 0}) - d,
                          field(p + Vec3d{0, 0, h}) - d}) *
         d;
  }
  return p;
}

/// Light from the open sky above the surface, 0..1, by walking outwards.
template <class Field>
double open_sky(const Field& field, Vec3d p, Vec3d normal, double reach) {
  double closed = 0;
  double weight = 0;
  for (int i = 1; i <= 6; ++i) {
    const double step = reach * double(i * i) / 36;
    const double w = 1.0 / double(i);
    const double d = std::clamp(field(p + normal * step), 0.0, step);
    closed += w * (1 - d / step);
    weight += w;
  }
  return std::clamp(1 - closed / weight, 0.0, 1.0);
}

}  // namespace animeme::head::detail
