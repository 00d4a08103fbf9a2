// The bones of a head, by the names that programs give them.
#pragma once

#include <array>
#include <vector>

#include "tools/view/gltf/detail/nodes.h"

namespace animeme::gltf {

/// Nodes, kNoNode where there is none. A VRM file names them itself; else the first bone counts
/// whose name has the word (head, neck, eye with left or right, jaw) and no word of another bone
/// (brow, lid, lash, end, target ...). Mixamo, Ready Player Me, Avaturn, VRoid, Character Creator,
/// MetaHuman and MakeHuman are met by that.
struct HeadJoints {
  std::size_t head = kNoNode;
  std::vector<std::size_t> neck;  ///< from the spine up; those above the last are the head's
  std::array<std::size_t, 2> eyes = {kNoNode, kNoNode};  ///< left, right
  std::size_t jaw = kNoNode;
};

/// The node of a bone of VRM's humanoid ("leftUpperArm"); kNoNode: the file does not say.
std::size_t human_bone(const File& file, const char* name);

HeadJoints find_joints(const File& file, const std::vector<Node>& nodes);

/// For each node: how far it turns with the head: 1 for the head and all below, in equal steps from
/// 0 for the bones of the neck, 0 for the rest. Empty without head and neck.
std::vector<float> neck_shares(const std::vector<Node>& nodes, const HeadJoints& joints);

}  // namespace animeme::gltf
