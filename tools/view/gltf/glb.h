/// @file
/// Writes a head and its motion as a glTF 2.0 file for Blender, Unreal, Unity, Godot and three.js.
///
///     GlbOptions options{.morphs = MorphNames::arkit, .audio = "voice.wav"};
///     Result<std::vector<std::uint8_t>> file = make_glb(head, rig, filled_clip, options);
///
/// Contents: a mesh for each part of the head with vertex colours; named morph targets
/// (mesh.extras.targetNames); bones for neck, jaw and eyes; one animation of weights and bones with
/// a key at each frame. Metres, +Y up, the face looks along +Z.
///
/// An imported head (read_head.h) keeps its own shapes as morph targets regardless of
/// GlbOptions::morphs; their weights are those of head::control_values().
///
/// Morph targets are linear, but the rig is not quite: players do not resolve lip contact, and lids
/// are exact only at 0 and 1. The jaw bone carries lower teeth and tongue.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/head/rig.h"
#include "fap/result.h"

/// glTF 2.0 import and export of heads and their motion.
namespace animeme::gltf {

/// Morph targets of a file.
enum class MorphNames : std::uint8_t {
  arkit,  ///< the 52 shapes of ARKit ("jawOpen"), fitted to the clip; the eyes turn by bones
  fap,    ///< one per FAP ("open_jaw"); weight 1 is 1024 units
};

/// Options of make_glb().
struct GlbOptions {
  MorphNames morphs = MorphNames::arkit;  ///< ignored for imported heads with shapes
  std::string audio;  ///< name of the sound file, for scene.extras.audio; empty: none
  std::string name;   ///< of the animation; empty: "talk"
  /// Smaller vertex displacements are omitted, cm.
  float smallest_move = 0.002f;
  /// Also write normals of the morph targets: the file is twice as large, and shading is better in
  /// players that do not compute them (three.js).
  bool normals = false;
  /// What is said, by frame: see head::PoseOptions::visemes. Empty: unknown.
  std::vector<fap::VisemeWeights> visemes = {};
  std::function<void(double)> progress = {};  ///< 0..1; empty: not wanted
};

/// Makes the file. `clip` should be complete (fap::fill()); missing frame numbers have no key, so
/// players interpolate. FAP 1 and 2 are converted by head::low_level(). Deterministic. Errors:
/// invalid_argument (no frame, or an invalid rate), out_of_range (more than 4 GB).
Result<std::vector<std::uint8_t>> make_glb(const head::Head& head, const head::Rig& rig,
                                           const fap::Sequence& clip,
                                           const GlbOptions& options = {});

}  // namespace animeme::gltf
