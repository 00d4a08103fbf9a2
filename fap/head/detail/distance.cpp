#include "fap/head/detail/distance.h"

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

void Form::add(const Primitive& body) {
  Part part{};
  part.blend = body.blend;
  part.sign = body.join == Join::add ? 1 : -1;
  Vec3d inverse{1, 1, 1};
  Vec3d middle = body.a;
  if (body.body == Body::cone) {
    part.a = body.a;
    part.ab = body.b - body.a;
    part.inverse_square = 1 / dot(part.ab, part.ab);
    part.ra = body.ra;
    part.widening = body.rb - body.ra;
    middle = mix(body.a, body.b, 0.5);
    part.start = 0.5 * length(part.ab) + std::max(body.ra, body.rb);
    part.slope = 1;
  } else {
    part.is_ball = true;
    inverse = {1 / body.b.x, 1 / body.b.y, 1 / body.b.z};
    part.start = part.least = 1;
    part.slope = std::max({inverse.x, inverse.y, inverse.z});
    part.radius = std::min({body.b.x, body.b.y, body.b.z});
  }
  const double numbers[] = {middle.x, middle.y, middle.z, inverse.x, inverse.y, inverse.z};
  for (std::size_t k = 0; k < 6; ++k) places_[k][parts_.size()] = numbers[k];
  parts_.push_back(part);
}

double Form::operator()(Vec3d p) const {
  // Rounded, lest bodies beside the middle meet their mirror images in a crease.
  constexpr double kRound = 0.28, kRounding = 1e-9;
  p.x = std::sqrt(p.x * p.x + kRound * kRound);
  const auto& [cx, cy, cz, ix, iy, iz] = places_;
  std::array<double, kMostBodies> qx, qy, qz, squares;
  for (std::size_t i = 0; i < kMostBodies; ++i) {
    qx[i] = (p.x - cx[i]) * ix[i];
    qy[i] = (p.y - cy[i]) * iy[i];
    qz[i] = (p.z - cz[i]) * iz[i];
    squares[i] = qx[i] * qx[i] + qy[i] * qy[i] + qz[i] * qz[i];
  }
  double d = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    // Where two distances differ by the blend or more, smooth_min() is exactly the lesser one.
    const double far = part.start + (part.sign * d + part.blend + kRounding) * part.slope;
    if (i > 0 && far > part.least && squares[i] > far * far) continue;
    double other;
    if (part.is_ball) {
      // As ellipsoid().
      const Vec3d b{qx[i] * ix[i], qy[i] * iy[i], qz[i] * iz[i]};
      const double k0 = std::sqrt(squares[i]), k1 = length(b);
      other = k1 < 1e-12 ? -part.radius : k0 * (k0 - 1) / k1;
    } else {
      const Vec3d q = p - part.a;
      const double t = std::clamp(dot(q, part.ab) * part.inverse_square, 0.0, 1.0);
      other = length(q - part.ab * t) - (part.ra + part.widening * t);
    }
    d = i == 0 ? other : part.sign * smooth_min(part.sign * d, other, part.blend);
  }
  return d;
}

}  // namespace animeme::head::detail
