// Animations of a file from clips of FAPs.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/gltf/detail/clip_keys.h"
#include "tools/view/gltf/detail/file_actor.h"
#include "tools/view/gltf/detail/file_edit.h"

namespace animeme::gltf {

/// The nodes of a file that move.
class FileMotion {
 public:
  /// All of these have to outlive it. Nodes that cannot be animated as they are get other members,
  /// or are left out, with a note.
  FileMotion(FileEdit& edit, const std::vector<Node>& nodes, const FileActor& actor,
             std::vector<std::string>& notes);

  std::size_t meshes() const { return meshes_.size(); }
  std::size_t bones() const { return bones_.size(); }

  /// One more animation. `audio`: for its extras; empty: none.
  void add(const fap::Sequence& clip, const std::string& name, const std::string& audio,
           const std::function<void(double)>& progress);

 private:
  struct MovedMesh {
    std::size_t node = 0;
    std::vector<std::size_t> shapes;  // of each target; kNoNode: it stays at rest
    std::vector<float> rest;          // weights
  };
  struct MovedBone {
    std::size_t node = 0;
    Bone bone = Bone::neck;
    double share = 1;
    NodeTurn turn;
  };
  void find_meshes();
  void find_bones(std::vector<std::string>& notes);
  void add_bone(std::size_t node, Bone bone, double share, std::vector<std::string>& notes);
  void add_channel(Json& animation, std::size_t times, std::size_t values, std::size_t node,
                   const char* path);
  void add_weights(Json& animation, std::size_t times,
                   const std::vector<std::vector<float>>& weights);
  void add_turns(Json& animation, std::size_t times, const ClipKeys& keys);

  FileEdit& edit_;
  const std::vector<Node>& nodes_;
  const FileActor& actor_;
  std::vector<MovedMesh> meshes_;
  std::vector<MovedBone> bones_;
};

}  // namespace animeme::gltf
