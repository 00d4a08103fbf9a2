// What shapes of whole faces do above the mouth.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// Adds, for each shape that shows an expression, one that moves brows, eyes and cheeks alone, so
/// that the mouth can speak beside it. Needs eyes; without them nothing is added.
void add_upper_faces(Rig& rig);

}  // namespace animeme::head::detail
