#include "tools/view/gltf/detail/vrm.h"

#include "tools/view/gltf/detail/target_names.h"

namespace animeme::gltf {
namespace {

struct Bind {
  std::size_t mesh = 0;
  std::size_t target = 0;
  double weight = 0;  // 0..1
};

void add(const std::string& name, const std::vector<Bind>& binds, TargetNames& names) {
  for (const Bind& bind : binds) {
    int same_mesh = 0;
    for (const Bind& other : binds) same_mesh += other.mesh == bind.mesh;
    if (same_mesh == 1 && bind.weight > 0.99) names.try_emplace({bind.mesh, bind.target}, name);
  }
}

TargetNames all_expressions(const File& file, const std::vector<Node>& nodes) {
  TargetNames names;
  const Json& old = member(file.root, "extensions", "VRM", "blendShapeMaster");
  for (const Json& group : list(old, "blendShapeGroups")) {
    std::vector<Bind> binds;
    for (const Json& bind : list(group, "binds")) {
      binds.push_back({whole_or(member(bind, "mesh"), kNoNode),
                       whole_or(member(bind, "index"), kNoNode),
                       number_or(member(bind, "weight"), 0) / 100});
    }
    add(text_or(member(group, "presetName")), binds, names);
  }
  const Json& presets = member(file.root, "extensions", "VRMC_vrm", "expressions", "preset");
  if (!presets.is_object()) return names;
  for (const auto& [name, expression] : presets.items()) {
    std::vector<Bind> binds;
    for (const Json& bind : list(expression, "morphTargetBinds")) {
      const std::size_t node = whole_or(member(bind, "node"), kNoNode);
      if (node >= nodes.size() || !nodes[node].mesh) continue;
      binds.push_back({*nodes[node].mesh, whole_or(member(bind, "index"), kNoNode),
                       number_or(member(bind, "weight"), 0)});
    }
    add(name, binds, names);
  }
  return names;
}

}  // namespace

TargetNames vrm_expressions(const File& file, const std::vector<Node>& nodes,
                            const ShapeRules& rules) {
  TargetNames names = all_expressions(file, nodes);
  if (rules.empty()) return names;
  std::erase_if(names, [&](const auto& entry) {
    const auto& [mesh, target] = entry.first;
    return find_rule(rules, own_target_name(file, mesh, target)) != nullptr;
  });
  return names;
}

}  // namespace animeme::gltf
