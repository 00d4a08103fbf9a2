// What files say and our rig knows better.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// True for moves of teeth and tongue with the jaw and of the eyeballs: the rig turns them.
inline bool left_to_rig(const Piece& piece, int fap) {
  const std::optional<Part> part = part_by_name(piece.name, piece.material);
  const bool eye = part == Part::left_eye || part == Part::right_eye;
  const bool jaw = part == Part::lower_teeth || part == Part::tongue;
  return (jaw && (fap == 3 || fap == 14 || fap == 15)) || (eye && fap >= 23 && fap <= 28);
}

}  // namespace animeme::head::detail
