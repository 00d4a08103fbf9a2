// What a head from the cache has to be, before anything indexes with what it says.
#pragma once

#include "fap/head/model.h"

namespace animeme::studio {

/// True if each number of the head is finite, each index is within its list, lists that belong
/// together have the same length, and each control is a FAP that moves something.
bool is_sound(const head::Head& head);

}  // namespace animeme::studio
