// What a face does not do, whatever its FAPs say.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// Changes values by control, low-level FAPs by number, to what the face can do.
void stop_at_contact(const Rig& rig, ControlValues& values);

/// Limits of usual faces.
std::vector<Reach> usual_reaches();

}  // namespace animeme::head::detail
