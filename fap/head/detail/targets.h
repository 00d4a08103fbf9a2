// The linear part of a rig, and skin that rests on the teeth.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// All targets of a head, by FAP and part.
std::vector<Target> make_targets(const Head& head);

/// The jaw for FAPs 3, 14 and 15 of these values.
Transform jaw_transform(const Rig& rig, float open, float thrust, float shift);

/// The form of a row of teeth, and the skin before it. Nothing if the part has no mesh.
DentalArch dental_arch(const Rig& rig, Part teeth);

/// Skin that was pushed into a row of teeth comes out again. `place` is that of the row.
void keep_off_teeth(const Rig& rig, const DentalArch& arch, const Transform& place,
                    std::vector<Vec3>& skin);

}  // namespace animeme::head::detail
