#include "tools/view/gltf/detail/bones.h"

#include <cmath>

namespace animeme::gltf {
namespace {

using head::Part;
using head::Transform;
using head::Vec3;

// A bone at `pivot` under a parent at `parent` that does what `move` does to points of the head.
BoneKey key(const Transform& move, Vec3 pivot, Vec3 parent) {
  const auto row = [](Vec3 v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  const auto q = quaternion_of({row(move.row_x), row(move.row_y), row(move.row_z)});
  return {{float(q[0]), float(q[1]), float(q[2]), float(q[3])}, (move(pivot) - parent) * kMetres};
}

}  // namespace

std::array<double, 4> quaternion_of(const std::array<std::array<double, 3>, 3>& m) {
  // The largest of the four parts is found first: dividing by it is safe.
  const std::array<double, 4> squares = {
      1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
      1 - m[0][0] - m[1][1] + m[2][2], 1 + m[0][0] + m[1][1] + m[2][2]};
  std::size_t best = 3;
  for (std::size_t i = 0; i < 4; ++i) {
    if (squares[i] > squares[best] + 1e-6) best = i;
  }
  const double s = 0.5 / std::sqrt(squares[best]);
  const double x = m[2][1] - m[1][2], y = m[0][2] - m[2][0], z = m[1][0] - m[0][1];
  const double xy = m[0][1] + m[1][0], xz = m[0][2] + m[2][0], yz = m[1][2] + m[2][1];
  std::array<double, 4> q = {x * s, y * s, z * s, squares[3] * s};
  if (best == 0) q = {squares[0] * s, xy * s, xz * s, x * s};
  if (best == 1) q = {xy * s, squares[1] * s, yz * s, y * s};
  if (best == 2) q = {xz * s, yz * s, squares[2] * s, z * s};
  if (q[3] < 0) {
    for (double& part : q) part = -part;
  }
  return q;
}

Vec3 pivot_of(const head::Rig& rig, Bone bone) {
  switch (bone) {
    case Bone::neck:
      return rig.neck_pivot;
    case Bone::jaw:
      return rig.jaw_axis;
    case Bone::left_eye:
      return rig.eyes[0].centre;
    case Bone::right_eye:
      return rig.eyes[1].centre;
  }
  return {};
}

std::array<BoneKey, kBoneCount> bones_of(const head::Rig& rig, const head::Pose& pose) {
  const Transform back = inverse(pose.head);
  const auto within = [&](Part part) {
    return head::compose(back, pose.transforms[std::size_t(part)]);
  };
  return {key(pose.head, rig.neck_pivot, {0, 0, 0}), key(pose.jaw, rig.jaw_axis, rig.neck_pivot),
          key(within(Part::left_eye), rig.eyes[0].centre, rig.neck_pivot),
          key(within(Part::right_eye), rig.eyes[1].centre, rig.neck_pivot)};
}

}  // namespace animeme::gltf
