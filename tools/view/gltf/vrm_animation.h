/// @file
/// Motion for VRM 1.0 avatars as a separate file (.vrma) for VRM viewers.
///
///     Result<VrmAnimation> file = vrm_animation(bytes_of_me_vrm, {{"talk", filled_clip}});
///
/// A .vrma has no mesh, only the skeleton of the avatar at rest, a node for each of its expressions
/// that the clips use (extension VRMC_vrm_animation 1.0: the weight is X of its place), rotations
/// of head and neck, and the gaze. So only expressions move: a shape without an expression of its
/// own stays at rest, with a note.
#pragma once

#include "tools/view/gltf/animate_file.h"

namespace animeme::gltf {

/// The file and its contents.
struct VrmAnimation {
  std::vector<std::uint8_t> file;        ///< a .glb file
  std::vector<std::string> names;        ///< of the animations, one per clip
  std::vector<std::string> expressions;  ///< expressions of the avatar that move
  std::vector<std::string> notes;        ///< what was guessed or left out, a sentence each
};

/// `avatar`: a VRM 1.0 file. Sounds of the clips are not included. Players use the first animation;
/// some offer a choice. Deterministic.
/// Errors: those of animate_file(); unsupported (not VRM 1.0); not_found (no known expression).
Result<VrmAnimation> vrm_animation(std::span<const std::uint8_t> avatar,
                                   std::span<const NamedClip> clips,
                                   const AnimateOptions& options = {});

}  // namespace animeme::gltf
