// Arms that are stretched out at rest.
#pragma once

#include <vector>

#include "tools/view/gltf/detail/nodes.h"

namespace animeme::gltf {

/// Turns upper arms that are stretched out sideways (T pose, A pose) down to 75 degrees below the
/// horizontal, with all that hangs on them: pictures show head and shoulders, and a person who
/// talks does not hold out her arms. Bones of VRM's humanoid, else by the names of upper arms that
/// programs write (LeftArm, upperarm_l, J_Bip_L_UpperArm ...) below which there is a lower arm or a
/// hand. Arms that already hang, or point elsewhere, stay. `nodes` are changed in place.
void lower_arms(const File& file, std::vector<Node>& nodes);

}  // namespace animeme::gltf
