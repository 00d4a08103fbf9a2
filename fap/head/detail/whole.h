// Skin that does not turn over, whatever its FAPs say.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// The skin that is seen: what can be reached from the chin without crossing the contact line of
/// the lips and the rims of the lids, at which skin rolls in. Empty for heads without these.
std::vector<OuterTriangle> outside_of(const Head& head);

/// As far as any of ARKit's shapes moves each FAP, a tenth of its range at the least: what captures
/// have, and is shown as it is.
std::array<float, fap::kFapCount + 1> usual_values();

/// Sets OuterTriangle::rolls, by ARKit's jawOpen. The rig must be complete but for that.
void mark_rolling(Rig& rig);

/// Shows values by control by `show`, which places the skin: those that are wanted; where triangles
/// of the outside turn over, as large a share of all that bend skin as leaves it whole. So faces
/// stay as they are until the first triangle stands on its edge, and go on smoothly from there.
void show_whole(const Rig& rig, const ControlValues& wanted, const std::vector<Vec3>& skin,
                const std::function<void(const ControlValues&)>& show);

}  // namespace animeme::head::detail
