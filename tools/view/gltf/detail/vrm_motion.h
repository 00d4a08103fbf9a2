// What moves in an avatar of VRM 1.0, by the names that VRM has for it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/view/gltf/detail/file_actor.h"

namespace animeme::gltf {

/// An expression that shows one shape of a head and nothing else.
struct ShownShape {
  std::string name;       ///< of the expression
  bool custom = false;    ///< not one of VRM's own
  std::size_t shape = 0;  ///< of FileActor::shape_names
  double weight = 1;      ///< of the shape at an expression of 1
};

/// For each shape the first of its expressions, VRM's own before others; none of the gaze.
std::vector<ShownShape> shown_shapes(const File& file, const std::vector<Node>& nodes,
                                     const FileActor& actor);

/// The bones of a human, without eyes, which animations may not turn: nodes by name.
std::map<std::string, std::size_t> human_bones(const File& file, const std::vector<Node>& nodes);

}  // namespace animeme::gltf
