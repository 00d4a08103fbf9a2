#include "tools/view/gltf/detail/joints.h"

#include <algorithm>

#include "tools/view/gltf/detail/words.h"

namespace animeme::gltf {
namespace {

bool any_of(const std::vector<std::string>& words, std::initializer_list<const char*> wanted) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const char* word) { return has_word(words, word); });
}

// Things near a bone that bear its name.
bool is_helper(const std::vector<std::string>& words) {
  return any_of(words, {"end", "top", "nub", "target", "ctrl", "control", "ik", "pole", "mesh",
                        "hair", "twist", "offset", "physics", "collider"});
}

bool is_other_eye(const std::vector<std::string>& words) {
  return any_of(words,
                {"brow",  "eyebrow", "lid",   "eyelid", "lash",      "eyelash", "lids", "blink",
                 "upper", "lower",   "inner", "outer",  "bottom",    "corner",  "look", "socket",
                 "bag",   "bags",    "pupil", "iris",   "highlight", "squint",  "cheek"});
}

// Words that mean an eye, also behind a prefix of the same word ("faceeye").
bool has_eye(const std::vector<std::string>& words) {
  return any_of(words, {"eye", "eyeball", "lefteye", "righteye", "eyeleft", "eyeright", "leye",
                        "reye", "faceeye"});
}

int side_of(const std::vector<std::string>& words) {
  if (any_of(words, {"left", "lefteye", "eyeleft", "leye", "lf"})) return 0;
  if (any_of(words, {"right", "righteye", "eyeright", "reye", "rt"})) return 1;
  return -1;
}

// Nodes that skins use, or all but meshes if there is no skin.
std::vector<bool> joint_nodes(const File& file, const std::vector<Node>& nodes) {
  std::vector<bool> bones(nodes.size(), false);
  bool any = false;
  for (const Json& skin : list(file.root, "skins")) {
    for (const Json& joint : list(skin, "joints")) {
      const std::size_t index = whole_or(joint, kNoNode);
      if (index < nodes.size()) any = bones[index] = true;
    }
  }
  // Bones of eyes without weights are often in no skin.
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool under_bone = nodes[i].parent != kNoNode && bones[nodes[i].parent];
    if ((!any || under_bone) && !nodes[i].mesh) bones[i] = true;
  }
  return bones;
}

void find_by_name(const std::vector<Node>& nodes, const std::vector<bool>& bones,
                  HeadJoints& joints) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!bones[i]) continue;
    const std::vector<std::string> words = words_of(nodes[i].name);
    if (is_helper(words)) continue;
    const auto take = [&](std::size_t& bone) { bone = bone == kNoNode ? i : bone; };
    if (has_eye(words) && !is_other_eye(words) && side_of(words) >= 0) {
      take(joints.eyes[std::size_t(side_of(words))]);
    } else if (has_word(words, "head") && !has_eye(words) && !has_word(words, "jaw")) {
      take(joints.head);
    } else if (has_word(words, "neck")) {
      joints.neck.push_back(i);
    } else if (any_of(words, {"jaw", "jawroot", "mandible", "lowerjaw"}) &&
               !any_of(words, {"upper", "left", "right"})) {
      take(joints.jaw);
    }
  }
}

std::size_t depth_of(const std::vector<Node>& nodes, std::size_t node) {
  std::size_t depth = 0;
  for (; nodes[node].parent != kNoNode; node = nodes[node].parent) ++depth;
  return depth;
}

// Those above the head, from below; without a head those on the way to the first.
void sort_neck(const std::vector<Node>& nodes, HeadJoints& joints) {
  if (joints.neck.empty()) return;
  constexpr std::size_t kMost = 8;
  if (joints.neck.size() > kMost) joints.neck.resize(kMost);
  std::erase_if(joints.neck, [&](std::size_t bone) {
    return joints.head != kNoNode && !nodes_below(nodes, bone)[joints.head];
  });
  std::stable_sort(joints.neck.begin(), joints.neck.end(), [&](std::size_t a, std::size_t b) {
    return depth_of(nodes, a) < depth_of(nodes, b);
  });
}

}  // namespace

// VRM 0.x has a list, VRM 1.0 an object.
std::size_t human_bone(const File& file, const char* name) {
  for (const Json& bone : list(member(file.root, "extensions", "VRM", "humanoid"), "humanBones")) {
    if (text_or(member(bone, "bone")) == name) return whole_or(member(bone, "node"), kNoNode);
  }
  return whole_or(
      member(file.root, "extensions", "VRMC_vrm", "humanoid", "humanBones", name, "node"), kNoNode);
}

HeadJoints find_joints(const File& file, const std::vector<Node>& nodes) {
  HeadJoints joints;
  const auto known = [&](const char* name) {
    const std::size_t bone = human_bone(file, name);
    return bone < nodes.size() ? bone : kNoNode;
  };
  joints.head = known("head");
  joints.eyes = {known("leftEye"), known("rightEye")};
  joints.jaw = known("jaw");
  find_by_name(nodes, joint_nodes(file, nodes), joints);
  sort_neck(nodes, joints);
  // The last bone of a neck without a head carries the head.
  if (joints.head == kNoNode && !joints.neck.empty()) {
    joints.head = joints.neck.back();
    joints.neck.pop_back();
  }
  return joints;
}

std::vector<float> neck_shares(const std::vector<Node>& nodes, const HeadJoints& joints) {
  std::vector<float> shares;
  if (joints.head == kNoNode) return shares;
  shares.assign(nodes.size(), 0);
  const auto mark = [&](std::size_t bone, float share) {
    const std::vector<bool> below = nodes_below(nodes, bone);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (below[i]) shares[i] = share;
    }
  };
  const float steps = float(joints.neck.size()) + 1;
  for (std::size_t i = 0; i < joints.neck.size(); ++i) {
    mark(joints.neck[i], float(i + 1) / steps);
  }
  mark(joints.head, 1);
  return shares;
}

}  // namespace animeme::gltf
