// What a head shows in each frame of a clip, for animations.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "fap/frame.h"
#include "fap/viseme.h"
#include "tools/view/gltf/detail/bones.h"
#include "tools/view/gltf/detail/node_turn.h"

namespace animeme::gltf {

struct ClipKeys {
  std::vector<float> times;                 ///< seconds from the first frame on
  std::vector<std::vector<float>> weights;  ///< of the shapes of the rig
  std::vector<std::array<BoneKey, kBoneCount>> bones;
};

/// `visemes`: what is said, by frame (head::PoseOptions::visemes), or empty. `progress` gets 0..1.
ClipKeys keys_of_clip(const head::Rig& rig, const fap::Sequence& clip,
                      std::span<const fap::VisemeWeights> visemes,
                      const std::function<void(double)>& progress);

/// Rotations of a node that makes a share of the turns of a bone, four numbers a key, the shorter
/// way from key to key.
std::vector<float> rotation_keys(const NodeTurn& node, const ClipKeys& keys, Bone bone,
                                 double share);

/// True if the bone turns in any key.
bool turns(const ClipKeys& keys, Bone bone);

}  // namespace animeme::gltf
