// What lies behind the slits of the skin: the bag of the mouth and the pockets of the eyes.
#pragma once

#include "fap/head/detail/grid.h"

namespace animeme::head::detail {

/// Lips from inside, vestibule, cavity; also the contact pairs and jaw weights.
void add_mouth_bag(const Shape& shape, Skin& skin);

/// Rim of the lids and a pocket inside the eyeball; side 1: left, -1: right. Also the contact
/// pairs and lid weights.
void add_eye_pocket(const Shape& shape, Skin& skin, int side);

}  // namespace animeme::head::detail
