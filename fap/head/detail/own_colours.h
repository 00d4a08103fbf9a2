// Colours of heads of others.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// Gives each part its material, and a colour to vertices of kNoColour: one for each part, lips
/// within the contour of the mouth if its points are known, pupil and iris on the eyes.
void colour_parts(Head& head);

}  // namespace animeme::head::detail
