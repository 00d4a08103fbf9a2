/// @file
/// What the 14 visemes of FAP 1 and the 6 expressions of FAP 2 look like: tables of low-level FAPs.
///
/// The standard names the shapes and leaves their form to the player; these are ours, chosen by eye
/// on the heads of this folder.
#pragma once

#include "fap/frame.h"

namespace animeme::head {

/// The low-level FAPs of viseme 0..14 at full strength; FAPs that rest are absent. Others: empty.
fap::Frame viseme_shape(int viseme);

/// The same for expression 0..6.
fap::Frame expression_shape(int expression);

/// The frame with its FAP 1 and 2 as low-level FAPs: viseme1 * blend/63 + viseme2 * (1 - blend/63)
/// + expression1 * intensity1/63 + expression2 * intensity2/63. Low-level FAPs that the frame has
/// itself win over those of the shapes. Source: fap/semantics.md, sections 4 and 5.
fap::Frame low_level(const fap::Frame& frame);

}  // namespace animeme::head
