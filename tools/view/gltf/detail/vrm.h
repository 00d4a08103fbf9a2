// What a VRM file says of its own morph targets.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "tools/view/gltf/detail/nodes.h"
#include "tools/view/gltf/shape_rules.h"

namespace animeme::gltf {

/// Names of morph targets by mesh and number.
using TargetNames = std::map<std::pair<std::size_t, std::size_t>, std::string>;

/// Names of expressions ("aa", "blinkLeft"; in VRM 0.x "a", "blink_l") by the mesh and the number
/// of the morph target that shows them. Expressions that need several targets of one mesh, or a
/// part of one, are left out; so are targets whose own names have a rule.
TargetNames vrm_expressions(const File& file, const std::vector<Node>& nodes,
                            const ShapeRules& rules);

}  // namespace animeme::gltf
