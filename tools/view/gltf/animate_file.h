/// @file
/// A glTF file of an avatar as it is, with animations added.
///
///     auto bytes = ...;  // me.glb
///     Result<AnimatedFile> file = animate_file(bytes, {{"talk", filled_clip}});
///     write(file->front), write(file->middle), write(file->back);
///
/// Every byte of the file stays: its text with the order of its members and the spelling of its
/// numbers, its buffers, pictures, extensions. New entries come at the end of `accessors`,
/// `bufferViews` and `animations`, new data at the end of the binary part of a .glb, or, in a
/// .gltf, as one more buffer within the text. `.vrm` is a .glb.
///
/// An animation has, with a key at each frame of the clip,
/// - `weights` of each node whose mesh has shapes that are used (read_head.h), with those weights
///   that head::control_values() finds; other targets keep the weights of node or mesh;
/// - rotations of the bones of the head, the neck (in equal shares), the eyes, unless shapes show
///   their gaze, and of a jaw that carries teeth and tongue alone; what does not move has no
///   channel. Keys are in the node's own space, from its place at rest.
///
/// A bone whose place is a matrix, which may not be animated, gets translation, rotation and scale
/// in its place, with a note; one that shears stays.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// A sound to be put into the file: WAV or MP3, which extension KHR_audio_emitter (a draft of
/// Khronos) knows. Players that do not know it leave it out.
struct FileSound {
  std::string type;                 ///< "audio/wav" or "audio/mpeg"
  std::vector<std::uint8_t> bytes;  ///< of the whole sound file
};

/// What becomes an animation.
struct NamedClip {
  std::string name;    ///< of the animation; one that is taken gets a number behind it
  fap::Sequence clip;  ///< complete (fap::fill()); its first frame is at 0 s
  std::optional<FileSound> sound = {};  ///< to put into the file
  std::string audio = {};  ///< name of its sound, for `extras.audio` of the animation; empty: none
};

/// What animate_file() is told.
struct AnimateOptions {
  ReadOptions reading = {};                   ///< how the head is read
  double mouth_gain = 1;                      ///< how much wider lips open: see fap/wider.h
  std::function<void(double)> progress = {};  ///< 0..1; empty: not wanted
};

/// The file, in three parts that follow each other.
struct AnimatedFile {
  std::vector<std::uint8_t> front;       ///< header and text
  std::span<const std::uint8_t> middle;  ///< borrowed from what was read
  std::vector<std::uint8_t> back;        ///< what is new
  std::vector<std::string> names;        ///< of the animations that were added
  std::size_t shapes = 0;                ///< that the clips may use
  std::size_t meshes = 0;                ///< nodes that have any of them
  std::size_t bones = 0;                 ///< that the head has, whether they move or not
  std::vector<std::string> notes;        ///< what was guessed or left out, a sentence each

  /// Bytes of all three.
  std::size_t size() const { return front.size() + middle.size() + back.size(); }
};

/// Adds animations. `bytes` have to outlive the result. Deterministic.
/// Errors: invalid_argument (no clip, one without a frame, a rate that is none), those of
/// read_head(); but a file whose meshes are compressed or too large is moved by the names of its
/// shapes, with a note; not_found (no shape is known); out_of_range (larger than 4 GB).
Result<AnimatedFile> animate_file(std::span<const std::uint8_t> bytes,
                                  std::span<const NamedClip> clips,
                                  const AnimateOptions& options = {});

}  // namespace animeme::gltf
