#include "fap/head/detail/distance.h"

#include <limits>

namespace animeme::head::detail {

double ellipsoid(Vec3d p, Vec3d radii) {
  const Vec3d a{p.x / radii.x, p.y / radii.y, p.z / radii.z};
  const Vec3d b{a.x / radii.x, a.y / radii.y, a.z / radii.z};
  const double k0 = length(a);
  const double k1 = length(b);
  if (k1 < 1e-12) return -std::min({radii.x, radii.y, radii.z});
  return k0 * (k0 - 1) / k1;
}

double cone(Vec3d p, Vec3d a, Vec3d b, double ra, double rb) {
  const Vec3d ab = b - a;
  const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
  return length(p - (a + ab * t)) - (ra + (rb - ra) * t);
}

double smooth_min(double a, double b, double k) {
  if (k <= 0) return std::min(a, b);
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k * 0.25;
}

double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

namespace {

double distance(const Primitive& body, Vec3d p) {
  if (body.body == Body::cone) return cone(p, body.a, body.b, body.ra, body.rb);
  Vec3d q = p - body.a;
  if (body.tilt != 0) {
    const double c = std::cos(body.tilt);
    const double s = std::sin(body.tilt);
    q = {q.x, c * q.y + s * q.z, c * q.z - s * q.y};
  }
  return ellipsoid(q, body.b);
}

}  // namespace

double Form::operator()(Vec3d p) const {
  // Rounded, lest bodies beside the middle meet their mirror images in a crease.
  constexpr double kRound = 0.28;
  p.x = std::sqrt(p.x * p.x + kRound * kRound);
  double d = std::numeric_limits<double>::max();
  for (const Primitive& body : primitives) {
    const double other = distance(body, p);
    d = body.join == Join::add ? smooth_min(d, other, body.blend)
                               : smooth_max(d, -other, body.blend);
  }
  return d;
}

}  // namespace animeme::head::detail
