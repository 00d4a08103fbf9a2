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
  return ellipsoid(p - body.a, body.b);
}

}  // namespace

void Form::add(const Primitive& body) {
  Reach reach{};
  if (body.body == Body::cone) {
    reach.middle = mix(body.a, body.b, 0.5);
    reach.radius = 0.5 * length(body.b - body.a) + std::max(body.ra, body.rb);
  } else {
    reach.inverse = {1 / body.b.x, 1 / body.b.y, 1 / body.b.z};
    reach.inverse_least = std::max({reach.inverse.x, reach.inverse.y, reach.inverse.z});
  }
  primitives_.push_back(body);
  reaches_.push_back(reach);
}

// True: distance() is `least` or more. A cone lies in its ball. For an ellipsoid let k0 and k1 be
// the lengths of ellipsoid(): k1 <= k0 / its least radius, so from k0 >= 1 on the distance is not
// below (k0 - 1) least radius.
bool Form::beyond(const Primitive& body, const Reach& reach, Vec3d p, double least) {
  constexpr double kRounding = 1e-9;
  least += kRounding;
  if (body.body == Body::cone) {
    const Vec3d q = p - reach.middle;
    const double far = least + reach.radius;
    return far > 0 && dot(q, q) > far * far;
  }
  if (least < 0) return false;
  const Vec3d q = p - body.a;
  const Vec3d k{q.x * reach.inverse.x, q.y * reach.inverse.y, q.z * reach.inverse.z};
  const double far = 1 + least * reach.inverse_least;
  return dot(k, k) > far * far;
}

double Form::operator()(Vec3d p) const {
  // Rounded, lest bodies beside the middle meet their mirror images in a crease.
  constexpr double kRound = 0.28;
  p.x = std::sqrt(p.x * p.x + kRound * kRound);
  double d = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    const Primitive& body = primitives_[i];
    const bool adds = body.join == Join::add;
    // Where two distances differ by the blend or more, smooth_min() is exactly the lesser one.
    if (i > 0 && beyond(body, reaches_[i], p, (adds ? d : -d) + body.blend)) continue;
    const double other = distance(body, p);
    d = adds ? smooth_min(d, other, body.blend) : smooth_max(d, -other, body.blend);
  }
  return d;
}

}  // namespace animeme::head::detail
