#include "tools/gltf/detail/bones.h"

#include <cmath>

namespace animeme::gltf {
namespace {

using head::Part;
using head::Transform;
using head::Vec3;

// The unit quaternion of a rotation, w not negative.
std::array<float, 4> quaternion(const Transform& t) {
  const double m00 = t.row_x.x, m11 = t.row_y.y, m22 = t.row_z.z;
  // The largest of the four parts is found first: dividing by it is safe.
  const std::array<double, 4> squares = {1 + m00 - m11 - m22, 1 - m00 + m11 - m22,
                                         1 - m00 - m11 + m22, 1 + m00 + m11 + m22};
  std::size_t best = 3;
  for (std::size_t i = 0; i < 4; ++i) {
    if (squares[i] > squares[best] + 1e-6) best = i;
  }
  const double s = 0.5 / std::sqrt(squares[best]);
  const double yx = double(t.row_y.x), xy = double(t.row_x.y);
  const double zx = double(t.row_z.x), xz = double(t.row_x.z);
  const double zy = double(t.row_z.y), yz = double(t.row_y.z);
  std::array<double, 4> q = {};
  switch (best) {
    case 0:
      q = {squares[0] * s, (xy + yx) * s, (xz + zx) * s, (zy - yz) * s};
      break;
    case 1:
      q = {(xy + yx) * s, squares[1] * s, (yz + zy) * s, (xz - zx) * s};
      break;
    case 2:
      q = {(xz + zx) * s, (yz + zy) * s, squares[2] * s, (yx - xy) * s};
      break;
    default:
      q = {(zy - yz) * s, (xz - zx) * s, (yx - xy) * s, squares[3] * s};
  }
  const double sign = q[3] < 0 ? -1 : 1;
  return {float(sign * q[0]), float(sign * q[1]), float(sign * q[2]), float(sign * q[3])};
}

// A bone at `pivot` under a parent at `parent` that does what `move` does to points of the head.
BoneKey key(const Transform& move, Vec3 pivot, Vec3 parent) {
  return {quaternion(move), (move(pivot) - parent) * kMetres};
}

}  // namespace

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
