// What moves in a file, and how a head of ours says by how much.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "fap/head/rig.h"
#include "tools/view/gltf/detail/joints.h"
#include "tools/view/gltf/detail/vrm.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

struct FileActor {
  head::Rig rig;  ///< without its meshes: for control_values() and bones_of()
  std::vector<std::vector<std::string>> shape_names;  ///< see MovedHead
  TargetNames expressions;                            ///< see vrm_expressions()
  HeadJoints joints;                                  ///< those that the rig turns
  std::array<head::Vec3, 3> axes = {head::Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double unit = 100;                 ///< cm of one unit of the file
  std::vector<std::string> unknown;  ///< see HeadFile
  std::vector<std::string> notes;
};

/// As animeme::head shows it, where the file can be read as a head; else, with a note, by the names
/// of shapes and bones alone: meshes that are compressed, too large, or without a face that could
/// be found. `file` is the JSON of `bytes`. Errors: those of read_head() beside unsupported and
/// out_of_range; not_found (no shape is known).
Result<FileActor> file_actor(std::span<const std::uint8_t> bytes, const File& file,
                             const std::vector<Node>& nodes, const ReadOptions& options);

/// Which shape (an index of `actor.shape_names`, kNoNode: none) each morph target of a mesh shows.
std::vector<std::size_t> shapes_of_targets(const File& file, const FileActor& actor,
                                           std::size_t mesh);

}  // namespace animeme::gltf
