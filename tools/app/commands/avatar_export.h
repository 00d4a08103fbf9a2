/// @file
/// Motion into the file of a head of the user's own, which stays what it is.
#pragma once

#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

/// True for names of glTF files: .glb, .gltf, .vrm.
bool is_gltf_name(const std::string& path);

/// True for what can be written for a head: those, and .vrma.
bool is_head_output(const std::string& path);

/// True for a glTF file that is moved by its own shapes (no --points).
bool moves_by_itself(const studio::HeadChoice& choice);

/// What is wrong with an output for a head that is made anew: it has to be a .glb. Empty: nothing.
std::string problem_of_built_head(const std::string& output, const studio::HeadChoice& choice);

/// A clip that becomes an animation.
struct AvatarClip {
  std::string path;    ///< its file
  double start = 0;    ///< of its first frame, seconds on the clock of its own sound
  fap::Sequence clip;  ///< complete
  std::vector<fap::VisemeWeights> visemes = {};  ///< what is said, by frame; empty: unknown
};

/// What is to be done.
struct AvatarExport {
  studio::HeadChoice head;          ///< .glb, .gltf or .vrm, without points
  std::string output;               ///< likewise, or .vrma
  std::string audio;                ///< name of the sound to mention; empty: none
  std::vector<std::string> sounds;  ///< files to put in, one a clip; empty: none
  std::vector<AvatarClip> clips;    ///< at least one
};

/// Writes the file and prints what was done. Errors: those of gltf::animate_file() or
/// gltf::vrm_animation(), of reading and writing; usage errors.
Result<int> export_avatar(const AvatarExport& job);

}  // namespace animeme::tools
