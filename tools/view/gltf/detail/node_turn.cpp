#include "tools/view/gltf/detail/node_turn.h"

#include <cmath>

namespace animeme::gltf {
namespace {

using head::Vec3d;

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quaternion unit_quaternion(const Quaternion& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0, 1};
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Vec3d column_of(const Affine& map, std::size_t column) {
  return {map.rows[0][column], map.rows[1][column], map.rows[2][column]};
}

std::optional<LocalPlace> place_of_matrix(const std::vector<double>& matrix) {
  const Affine map = affine_of(matrix.data());
  std::array<Vec3d, 3> axes;
  LocalPlace place;
  place.of_matrix = true;
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = column_of(map, i);
    place.scale[i] = head::length(axes[i]);
    if (!(place.scale[i] > 1e-12)) return std::nullopt;
    axes[i] = axes[i] * (1 / place.scale[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(head::dot(axes[i], axes[(i + 1) % 3])) > 1e-4) return std::nullopt;
  }
  if (head::dot(head::cross(axes[0], axes[1]), axes[2]) < 0) {
    axes[0] = axes[0] * -1.0;
    place.scale[0] = -place.scale[0];
  }
  const auto [x, y, z] = axes;
  const Quaternion turn = quaternion_of({{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}});
  place.rotation = turn;
  const Vec3d origin = map.origin();
  place.translation = {origin.x, origin.y, origin.z};
  return place;
}

}  // namespace

Quaternion share_of(const Quaternion& turn, double share) {
  const double sine = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  if (sine < 1e-12) return {0, 0, 0, 1};
  const double half = std::atan2(sine, turn[3]) * share;
  const double scale = std::sin(half) / sine;
  return {turn[0] * scale, turn[1] * scale, turn[2] * scale, std::cos(half)};
}

std::optional<LocalPlace> local_place(const Json& node) {
  if (const auto matrix = numbers(member(node, "matrix"), 16)) return place_of_matrix(*matrix);
  LocalPlace place;
  if (const auto t = numbers(member(node, "translation"), 3)) {
    place.translation = {(*t)[0], (*t)[1], (*t)[2]};
  }
  if (const auto r = numbers(member(node, "rotation"), 4)) {
    place.rotation = unit_quaternion({(*r)[0], (*r)[1], (*r)[2], (*r)[3]});
  }
  if (const auto s = numbers(member(node, "scale"), 3)) {
    place.scale = {(*s)[0], (*s)[1], (*s)[2]};
  }
  return place;
}

NodeTurn::NodeTurn(const LocalPlace& rest, const Affine& parent,
                   const std::array<head::Vec3, 3>& axes, double unit)
    : rest_(rest), unit_(unit > 0 ? unit : 1) {
  for (std::size_t i = 0; i < 3; ++i) axes_[i] = Vec3d(axes[i]);
  const Vec3d x = column_of(parent, 0), y = column_of(parent, 1), z = column_of(parent, 2);
  const double volume = head::dot(head::cross(x, y), z);
  mirrored_ = volume < 0 ? -1 : 1;
  const double scale = std::abs(volume) > 1e-30 ? 1 / volume : 0;
  into_parent_ = {head::cross(y, z) * scale, head::cross(z, x) * scale, head::cross(x, y) * scale};
}

Vec3d NodeTurn::into_parent(Vec3d of_head) const {
  const Vec3d world = axes_[0] * of_head.x + axes_[1] * of_head.y + axes_[2] * of_head.z;
  return {head::dot(into_parent_[0], world), head::dot(into_parent_[1], world),
          head::dot(into_parent_[2], world)};
}

// A turn about an axis is, seen from the parent, one about the axis there: its own scale does not
// count, but a mirror turns it round.
Quaternion NodeTurn::rotation(const Quaternion& turn) const {
  const Vec3d axis{turn[0], turn[1], turn[2]};
  const double sine = head::length(axis);
  const Vec3d there = head::normalised(into_parent(axis)) * (sine * mirrored_);
  return unit_quaternion(product({there.x, there.y, there.z, turn[3]}, rest_.rotation));
}

std::array<double, 3> NodeTurn::translation(head::Vec3 shift) const {
  const Vec3d step = into_parent(Vec3d(shift) * (1 / unit_));
  return {rest_.translation[0] + step.x, rest_.translation[1] + step.y,
          rest_.translation[2] + step.z};
}

}  // namespace animeme::gltf
