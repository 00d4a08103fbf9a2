#include "tools/view/gltf/detail/vrm_motion.h"

#include <algorithm>
#include <set>

namespace animeme::gltf {
namespace {

// The shape of the expression `json`; nothing if it shows none, or more than that.
std::optional<ShownShape> shown_shape(const Json& json, const std::vector<Node>& nodes,
                                      const std::vector<std::vector<std::size_t>>& targets) {
  std::optional<ShownShape> shown;
  for (const Json& bind : list(json, "morphTargetBinds")) {
    const double weight = number_or(member(bind, "weight"), 0);
    if (weight < 0.01) continue;
    const std::size_t node = whole_or(member(bind, "node"), kNoNode);
    const std::size_t target = whole_or(member(bind, "index"), kNoNode);
    if (node >= nodes.size() || target >= targets[node].size()) return std::nullopt;
    const std::size_t shape = targets[node][target];
    if (shape == kNoNode || (shown && shown->shape != shape)) return std::nullopt;
    if (!shown) shown = ShownShape{{}, false, shape, weight};
  }
  return shown;
}

}  // namespace

std::vector<ShownShape> shown_shapes(const File& file, const std::vector<Node>& nodes,
                                     const FileActor& actor) {
  const TargetNames expressions = vrm_expressions(file, nodes);
  std::vector<std::vector<std::size_t>> targets;
  for (const Node& node : nodes) {
    targets.emplace_back();
    if (!node.mesh) continue;
    targets.back() = shapes_of_targets(file, expressions, *node.mesh, actor.shape_names);
  }
  std::vector<ShownShape> all;
  std::set<std::size_t> taken;
  for (const bool custom : {false, true}) {
    const Json& of_kind =
        member(file.root, "extensions", "VRMC_vrm", "expressions", custom ? "custom" : "preset");
    if (!of_kind.is_object()) continue;
    for (const auto& [name, json] : of_kind.items()) {
      static const std::set<std::string> of_gaze = {"lookUp", "lookDown", "lookLeft", "lookRight"};
      if (of_gaze.count(name) > 0) continue;
      std::optional<ShownShape> shown = shown_shape(json, nodes, targets);
      if (!shown || !taken.insert(shown->shape).second) continue;
      shown->name = name;
      shown->custom = custom;
      all.push_back(*shown);
    }
  }
  return all;
}

std::map<std::string, std::size_t> human_bones(const File& file, const std::vector<Node>& nodes) {
  std::map<std::string, std::size_t> bones;
  std::set<std::size_t> taken;
  const Json& human = member(file.root, "extensions", "VRMC_vrm", "humanoid", "humanBones");
  if (!human.is_object()) return bones;
  for (const auto& [name, bone] : human.items()) {
    const std::size_t node = whole_or(member(bone, "node"), kNoNode);
    if (name == "leftEye" || name == "rightEye" || node >= nodes.size()) continue;
    if (taken.insert(node).second) bones[name] = node;
  }
  return bones;
}

}  // namespace animeme::gltf
