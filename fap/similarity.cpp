#include "fap/detail/similarity.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace animeme::fap::internal {
namespace {

using Quaternion = std::array<double, 4>;  // w, x, y, z
using Symmetric = std::array<Quaternion, 4>;

constexpr int kJacobiSweeps = 30;
constexpr int kRobustRounds = 6;     // of each kind
constexpr double kFarOff = 2.5;      // medians: counts less
constexpr double kLost = 4;          // medians: does not count
constexpr double kOneLine = 1e-9;    // of the largest eigenvalue
constexpr double kSmallest = 1e-10;  // of the size: below it everything fits

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// One rotation of Jacobi's method: makes m[p][q] zero, turns the columns of `vectors` along.
void rotate_away(Symmetric& m, Symmetric& vectors, std::size_t p, std::size_t q) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = m[k][p];
    const double b = m[k][q];
    m[k][p] = c * a - s * b;
    m[k][q] = s * a + c * b;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = m[p][k];
    const double b = m[q][k];
    m[p][k] = c * a - s * b;
    m[q][k] = s * a + c * b;
    const double u = vectors[k][p];
    const double v = vectors[k][q];
    vectors[k][p] = c * u - s * v;
    vectors[k][q] = s * u + c * v;
  }
}

// Eigenvector of the largest eigenvalue; nothing if the second is equal.
std::optional<Quaternion> largest_eigenvector(Symmetric m) {
  Symmetric vectors{};
  for (std::size_t i = 0; i < 4; ++i) vectors[i][i] = 1;
  for (int sweep = 0; sweep < kJacobiSweeps; ++sweep) {
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q) rotate_away(m, vectors, p, q);
    }
  }
  std::array<std::size_t, 4> order = {0, 1, 2, 3};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
  const double first = m[order[0]][order[0]];
  if (!(first - m[order[1]][order[1]] > kOneLine * std::abs(first))) return std::nullopt;
  Quaternion out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = vectors[i][order[0]];
  return out;
}

Rotation rotation_of(const Quaternion& q) {
  const auto [w, x, y, z] = q;
  return {Point{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
          Point{2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
          Point{2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
}

// The rotation R that makes the sum of to . R from largest; s[i][j] is the sum of from_i to_j.
std::optional<Rotation> best_rotation(const Rotation& s, bool depth) {
  if (!depth) {
    const double sine = s[0][1] - s[1][0];
    const double cosine = s[0][0] + s[1][1];
    const double length = std::hypot(sine, cosine);
    if (!(length > 0)) return std::nullopt;
    const double c = cosine / length;
    const double n = sine / length;
    return Rotation{Point{c, -n, 0}, Point{n, c, 0}, Point{0, 0, 1}};
  }
  const double xx = s[0][0], xy = s[0][1], xz = s[0][2];
  const double yx = s[1][0], yy = s[1][1], yz = s[1][2];
  const double zx = s[2][0], zy = s[2][1], zz = s[2][2];
  const auto q = largest_eigenvector({Quaternion{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                                      Quaternion{yz - zy, xx - yy - zz, xy + yx, zx + xz},
                                      Quaternion{zx - xz, xy + yx, -xx + yy - zz, yz + zy},
                                      Quaternion{xy - yx, zx + xz, yz + zy, -xx - yy + zz}});
  if (!q) return std::nullopt;
  return rotation_of(*q);
}

Point centre(std::span<const Point> points, std::span<const double> weights) {
  Point sum{};
  double total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += weights[i] * points[i][k];
    total += weights[i];
  }
  for (double& value : sum) value /= total;
  return sum;
}

double huber(double off) { return off > kFarOff ? kFarOff / off : 1.0; }

double tukey(double off) {
  const double rest = 1 - (off / kLost) * (off / kLost);
  return rest > 0 ? rest * rest : 0.0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Point rotated(const Rotation& rotation, const Point& point) {
  return {dot(rotation[0], point), dot(rotation[1], point), dot(rotation[2], point)};
}

Rotation transposed(const Rotation& rotation) {
  Rotation out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[j][i] = rotation[i][j];
  }
  return out;
}

Rotation product(const Rotation& a, const Rotation& b) {
  const Rotation columns = transposed(b);
  Rotation out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = dot(a[i], columns[j]);
  }
  return out;
}

Rotation mean_rotation(std::span<const Rotation> rotations) {
  Rotation sum{};
  for (const Rotation& rotation : rotations) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += rotation[j][i];
    }
  }
  return best_rotation(sum, true).value_or(kNoRotation);
}

Rotation shortest_rotation(const Point& from, const Point& to) {
  const double length = std::sqrt(dot(from, from) * dot(to, to));
  const Point axis = {from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2],
                      from[0] * to[1] - from[1] * to[0]};
  Quaternion q = {length + dot(from, to), axis[0], axis[1], axis[2]};
  const double norm = std::sqrt(q[0] * q[0] + dot(axis, axis));
  if (!(norm > 0)) return kNoRotation;
  for (double& value : q) value /= norm;
  return rotation_of(q);
}

Rotation rotation_of(const HeadAngles& angles) {
  const double cx = std::cos(angles.pitch), sx = std::sin(angles.pitch);
  const double cy = std::cos(angles.yaw), sy = std::sin(angles.yaw);
  const double cz = std::cos(angles.roll), sz = std::sin(angles.roll);
  const Rotation pitch = {Point{1, 0, 0}, Point{0, cx, -sx}, Point{0, sx, cx}};
  const Rotation yaw = {Point{cy, 0, sy}, Point{0, 1, 0}, Point{-sy, 0, cy}};
  const Rotation roll = {Point{cz, -sz, 0}, Point{sz, cz, 0}, Point{0, 0, 1}};
  return product(yaw, product(pitch, roll));
}

HeadAngles angles_of(const Rotation& r) {
  return {std::asin(std::clamp(-r[1][2], -1.0, 1.0)), std::atan2(r[0][2], r[2][2]),
          std::atan2(r[1][0], r[1][1])};
}

Point applied(const Similarity& pose, const Point& point) {
  Point out = rotated(pose.rotation, point);
  for (std::size_t k = 0; k < 3; ++k) out[k] = pose.scale * out[k] + pose.shift[k];
  return out;
}

Point taken_off(const Similarity& pose, const Point& point) {
  Point out = rotated(transposed(pose.rotation), minus(point, pose.shift));
  for (double& value : out) value /= pose.scale;
  return out;
}

std::optional<Similarity> fit_similarity(std::span<const Point> from, std::span<const Point> to,
                                         std::span<const double> weights, bool depth) {
  if (from.size() < (depth ? 3U : 2U)) return std::nullopt;
  const Point middle = centre(from, weights);
  const Point target = centre(to, weights);
  const std::size_t axes = depth ? 3 : 2;
  Rotation sums{};
  double power = 0;
  for (std::size_t n = 0; n < from.size(); ++n) {
    const Point a = minus(from[n], middle);
    const Point b = minus(to[n], target);
    for (std::size_t i = 0; i < axes; ++i) {
      power += weights[n] * a[i] * a[i];
      for (std::size_t j = 0; j < axes; ++j) sums[i][j] += weights[n] * a[i] * b[j];
    }
  }
  const std::optional<Rotation> rotation = best_rotation(sums, depth);
  if (!rotation || !(power > 0)) return std::nullopt;
  Similarity pose{*rotation, 0, {}};
  for (std::size_t i = 0; i < axes; ++i) {
    for (std::size_t j = 0; j < axes; ++j) pose.scale += (*rotation)[j][i] * sums[i][j] / power;
  }
  if (!(pose.scale > 0)) return std::nullopt;
  pose.shift = minus(target, applied(pose, middle));
  return pose;
}

std::optional<Similarity> fit_robustly(std::span<const Point> from, std::span<const Point> to,
                                       bool depth) {
  std::vector<double> weights(from.size(), 1.0);
  std::optional<Similarity> pose = fit_similarity(from, to, weights, depth);
  std::vector<double> off(from.size());
  for (int round = 0; pose && round < 2 * kRobustRounds; ++round) {
    double size = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Point difference = minus(to[i], applied(*pose, from[i]));
      off[i] = std::sqrt(dot(difference, difference));
      size = std::max(size, std::sqrt(dot(to[i], to[i])));
    }
    const double middle = std::max(median(off), kSmallest * size);
    const auto weigh = round < kRobustRounds ? huber : tukey;
    for (std::size_t i = 0; i < from.size(); ++i) weights[i] = weigh(off[i] / middle);
    const auto better = fit_similarity(from, to, weights, depth);
    if (!better) break;
    pose = better;
  }
  return pose;
}

}  // namespace animeme::fap::internal
