/// @file
/// Motion for avatars of VRM 1.0 as a file of its own (.vrma), which viewers of VRM play.
///
///     Result<VrmAnimation> file = vrm_animation(bytes_of_me_vrm, {{"talk", filled_clip}});
///
/// A .vrma has no mesh, only the skeleton of the avatar at rest, a node for each of its expressions
/// that the clips use (extension VRMC_vrm_animation 1.0: the weight is X of its place), turns of
/// head and neck, and one of the gaze. So what moves are expressions: a shape that none of them
/// shows alone stays at rest, with a note.
#pragma once

#include "tools/view/gltf/animate_file.h"

namespace animeme::gltf {

/// The file and what is in it.
struct VrmAnimation {
  std::vector<std::uint8_t> file;        ///< of the kind of a .glb
  std::vector<std::string> names;        ///< of the animations, one a clip
  std::vector<std::string> expressions;  ///< of the avatar, that move
  std::vector<std::string> notes;        ///< what was guessed or left out, a sentence each
};

/// `avatar`: a file of VRM 1.0. Sounds of the clips are not taken along. Players take the first
/// animation, some let choose. Deterministic.
/// Errors: those of animate_file(); unsupported (no VRM 1.0); not_found (no expression that is
/// known).
Result<VrmAnimation> vrm_animation(std::span<const std::uint8_t> avatar,
                                   std::span<const NamedClip> clips,
                                   const AnimateOptions& options = {});

}  // namespace animeme::gltf
