// A head from a file, with what the file itself would have to move to show the same.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/view/gltf/detail/joints.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

struct MovedHead {
  HeadFile file;
  /// For each of Source::shapes the names that mean it: of morph targets, or of expressions of VRM
  /// that stand for one.
  std::vector<std::vector<std::string>> shape_names;
  /// Bones that turn about their own place as head and eyes do; a jaw only if no skin hangs on it.
  HeadJoints joints;
  /// Directions of the file that become X, Y and Z of the head.
  std::array<head::Vec3, 3> axes = {head::Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// Errors: see read_head().
Result<MovedHead> read_moved_head(std::span<const std::uint8_t> bytes, const ReadOptions& options);

}  // namespace animeme::gltf
