// What cheeks do when the corners of a mouth rise.
#pragma once

#include "fap/head/detail/weights.h"

namespace animeme::head::detail {

/// Cheeks that rise with FAPs 6, 12 and 41, 7, 13 and 42 (not the other way: a frown does not press
/// them in): the apple of the cheek stands out, the nasolabial fold from the wing of the nose to
/// beside the corner of the mouth lies in. No feature point moves, which have FAPs of their own.
/// Nothing for sides on which the head lacks the points that define its position.
std::vector<Target> cheek_targets(const Head& head, const Weights& weights);

}  // namespace animeme::head::detail
