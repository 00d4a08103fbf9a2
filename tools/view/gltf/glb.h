/// @file
/// A head that moves as a glTF 2.0 file: for Blender, Unreal, Unity, Godot and three.js.
///
///     GlbOptions options{.morphs = MorphNames::arkit, .audio = "voice.wav"};
///     Result<std::vector<std::uint8_t>> file = make_glb(head, rig, filled_clip, options);
///
/// What is in it: a mesh for each part of the head with vertex colours; morph targets with names
/// (mesh.extras.targetNames); bones for the neck, the jaw and the eyes; one animation of weights
/// and bones with a key at each frame. Metres, +Y up, the face looks along +Z.
///
/// A head that has shapes of its own (read_head.h) gets these as morph targets, by their names,
/// whatever GlbOptions::morphs says; their weights are those of head::control_values().
///
/// Morph targets are linear, the rig is not quite: the lips of this head do not stop each other in
/// a player, and lids slide exactly at 0 and 1 only. The jaw bone carries lower teeth and tongue.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/head/rig.h"
#include "fap/result.h"

/// Heads and their motion as glTF 2.0, and back.
namespace animeme::gltf {

/// Which morph targets a file has.
enum class MorphNames : std::uint8_t {
  arkit,  ///< the 52 shapes of ARKit ("jawOpen"), fitted to the clip; the eyes turn by bones
  fap,    ///< one a FAP ("open_jaw"); weight 1 is 1024 units
};

/// What make_glb() writes.
struct GlbOptions {
  MorphNames morphs = MorphNames::arkit;  ///< ignored for heads with shapes of their own
  std::string audio;  ///< name of the sound beside it, for scene.extras.audio; empty: none
  std::string name;   ///< of the animation; empty: "talk"
  /// Moves of vertices below this are left out, cm.
  float smallest_move = 0.002f;
  /// Normals of the morph targets as well: the file is twice as large, and players that do not
  /// compute them (three.js) show better light.
  bool normals = false;
  std::function<void(double)> progress = {};  ///< 0..1; empty: not wanted
};

/// Makes the file. `clip` should be complete (fap::fill()); frame numbers that are missing have no
/// key, so players interpolate. FAP 1 and 2 are shown as head::low_level() says. Deterministic.
/// Errors: invalid_argument (no frame, or a rate that is none), out_of_range (more than 4 GB).
Result<std::vector<std::uint8_t>> make_glb(const head::Head& head, const head::Rig& rig,
                                           const fap::Sequence& clip,
                                           const GlbOptions& options = {});

}  // namespace animeme::gltf
