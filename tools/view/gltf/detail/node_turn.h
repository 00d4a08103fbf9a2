// Turns of the head as keys of a node in its own file.
#pragma once

#include <array>

#include "tools/view/gltf/detail/bones.h"
#include "tools/view/gltf/detail/nodes.h"

namespace animeme::gltf {

using Quaternion = std::array<double, 4>;  ///< x, y, z, w; length 1

/// A part of a rotation about the same axis: all of it at 1.
Quaternion share_of(const Quaternion& turn, double share);

/// The local transform of a node.
struct LocalPlace {
  std::array<double, 3> translation = {0, 0, 0};
  Quaternion rotation = {0, 0, 0, 1};
  std::array<double, 3> scale = {1, 1, 1};
  bool of_matrix = false;  ///< the file says it by a matrix
};

/// Nothing if its matrix shears, or is none.
std::optional<LocalPlace> local_place(const Json& node);

/// A node that turns about its own origin.
class NodeTurn {
 public:
  /// `axes`: directions of the file that are X, Y and Z of the head. `unit`: cm of one unit of the
  /// file.
  NodeTurn(const LocalPlace& rest, const Affine& parent, const std::array<head::Vec3, 3>& axes,
           double unit);

  /// Its rotation after a turn in the head's axes.
  Quaternion rotation(const Quaternion& turn) const;
  /// Its translation after a shift in the head's axes, cm.
  std::array<double, 3> translation(head::Vec3 shift) const;

 private:
  head::Vec3d into_parent(head::Vec3d of_head) const;

  LocalPlace rest_;
  std::array<head::Vec3d, 3> axes_;
  std::array<head::Vec3d, 3> into_parent_;  // rows of the inverse of the parent
  double mirrored_ = 1;
  double unit_;
};

}  // namespace animeme::gltf
