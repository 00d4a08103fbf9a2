// What a rig does with one FAP, by trying it: for formats that list moves of vertices.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// Moves of all vertices of the parts while a FAP goes from one value to another, per unit of it.
/// Parts that stay have no moves. Without contact; teeth, tongue and eyes move with jaw and gaze.
std::array<std::vector<Vec3>, kPartCount> moves_between(const Rig& rig, int fap, int from, int to);

}  // namespace animeme::head::detail
