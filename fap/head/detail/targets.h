// The linear part of a rig.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// All targets of a head, by FAP and part.
std::vector<Target> make_targets(const Head& head);

/// The jaw for FAPs 3, 14 and 15 of these values.
Transform jaw_transform(const Rig& rig, float open, float thrust, float shift);

}  // namespace animeme::head::detail
