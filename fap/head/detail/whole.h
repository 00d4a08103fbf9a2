// Skin that does not turn over, whatever its FAPs say.
#pragma once

#include <functional>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// Sets Rig::outside and Rig::usual of a rig that is complete but for them. The outside is what can
/// be reached from the chin without crossing the contact line of the lips and the rims of the lids,
/// at which skin rolls in; none on heads without these.
void watch_outside(const Head& head, Rig& rig);

/// Shows values by control by `show`, which places the skin: those that are wanted; where triangles
/// of the outside turn over, as large a share of all that bend skin as leaves it whole. So faces
/// stay as they are until the first triangle is edge-on, and continue smoothly from there.
void show_whole(const Rig& rig, const ControlValues& wanted, const std::vector<Vec3>& skin,
                const std::function<void(const ControlValues&)>& show);

}  // namespace animeme::head::detail
