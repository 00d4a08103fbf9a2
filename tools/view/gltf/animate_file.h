/// @file
/// Adds animations to an avatar's glTF file and leaves the rest unchanged.
///
///     auto bytes = ...;  // me.glb
///     Result<AnimatedFile> file = animate_file(bytes, {{"talk", filled_clip}});
///     write(file->front), write(file->middle), write(file->back);
/// Every byte of the file is preserved: its JSON with the order of members and the formatting of
/// numbers, its buffers, pictures, extensions. New entries are appended to `accessors`,
/// `bufferViews` and `animations`, new data to the binary chunk of a .glb or, in a .gltf, as an
/// additional embedded buffer. `.vrm` is a .glb.
///
/// An animation has, with a key at each frame of the clip,
/// - `weights` of each node whose mesh has shapes that are used (read_head.h), with the weights
///   of head::control_values(); other targets keep the weights of node or mesh;
/// - rotations of the bones of the head, the neck (in equal shares), the eyes (unless shapes move
///   them), and of a jaw that carries only teeth and tongue; what does not move has no channel.
///   Keys are in the node's local space, relative to its rest pose.
///
/// A bone with a matrix, which glTF does not allow to animate, gets translation, rotation and scale
/// instead, with a note; one with shear is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// A sound to be embedded: WAV or MP3, by the extension KHR_audio_emitter (a Khronos draft).
/// Players that do not know it ignore it.
struct FileSound {
  std::string type;                 ///< "audio/wav" or "audio/mpeg"
  std::vector<std::uint8_t> bytes;  ///< of the whole sound file
};

/// A clip to be added as an animation.
struct NamedClip {
  std::string name;                     ///< of the animation; a number is appended if it is taken
  fap::Sequence clip;                   ///< complete (fap::fill()); its first frame is at 0 s
  std::optional<FileSound> sound = {};  ///< to be embedded
  std::string audio = {};  ///< name of its sound, for `extras.audio` of the animation; empty: none
  /// What is said, by frame: see head::PoseOptions::visemes. Empty: unknown.
  std::vector<fap::VisemeWeights> visemes = {};
};

/// Options of animate_file().
struct AnimateOptions {
  ReadOptions reading = {};                   ///< options for reading the head
  double mouth_gain = 1;                      ///< gain of the lip opening: see fap/wider.h
  std::function<void(double)> progress = {};  ///< receives 0..1; may be empty
};

/// The file, in three consecutive parts.
struct AnimatedFile {
  std::vector<std::uint8_t> front;       ///< header and text
  std::span<const std::uint8_t> middle;  ///< borrowed from the input
  std::vector<std::uint8_t> back;        ///< new data
  std::vector<std::string> names;        ///< of the animations that were added
  std::size_t shapes = 0;                ///< number of shapes that the clips may use
  std::size_t meshes = 0;                ///< number of nodes with any of them
  std::size_t bones = 0;                 ///< number of bones of the head, whether they move or not
  std::vector<std::string> notes;        ///< what was guessed or dropped, one sentence each

  /// Total size in bytes.
  std::size_t size() const { return front.size() + middle.size() + back.size(); }
};

/// Adds animations. `bytes` must outlive the result. Deterministic.
/// Errors: invalid_argument (no clip, a clip without frames, an invalid rate), those of read_head()
/// (but a file whose meshes are compressed or too large is animated by the names of its shapes,
/// with a note); not_found (no known shape); out_of_range (larger than 4 GB).
Result<AnimatedFile> animate_file(std::span<const std::uint8_t> bytes,
                                  std::span<const NamedClip> clips,
                                  const AnimateOptions& options = {});

}  // namespace animeme::gltf
