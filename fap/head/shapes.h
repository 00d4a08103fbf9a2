/// @file
/// FAP 1 and 2 as shown by the heads of this folder: fap/expand.h under the names of this library.
#pragma once

#include "fap/expand.h"

namespace animeme::head {

/// fap::viseme_pose(): viseme 0..14 at full strength.
inline fap::Frame viseme_shape(int viseme) { return fap::viseme_pose(viseme); }
/// fap::expression_pose(): expression 0..6 at full strength.
inline fap::Frame expression_shape(int expression) { return fap::expression_pose(expression); }
using fap::low_level;

}  // namespace animeme::head
