// What readers and writers of face definitions ask of a head and its rig.
#pragma once

#include "fap/head/own_head.h"
#include "fap/head/rig.h"

namespace animeme::head::detail {

/// What a rig does with one FAP, by trying it, for formats that list moves of vertices: moves of
/// all vertices of the parts while the FAP goes from one value to another, per unit of it. Parts
/// that stay have no moves. Without contact; teeth, tongue and eyes move with jaw and gaze.
std::array<std::vector<Vec3>, kPartCount> moves_between(const Rig& rig, int fap, int from, int to);

/// True for moves of teeth and tongue with the jaw and of the eyeballs: the rig turns them.
inline bool left_to_rig(const Piece& piece, int fap) {
  const std::optional<Part> part = part_by_name(piece.name, piece.material);
  const bool eye = part == Part::left_eye || part == Part::right_eye;
  const bool jaw = part == Part::lower_teeth || part == Part::tongue;
  return (jaw && (fap == 3 || fap == 14 || fap == 15)) || (eye && fap >= 23 && fap <= 28);
}

/// Errors: invalid_argument (no feature point on the skin, no FAPU, a rig of another head).
Result<void> check_writable(const Head& head, const Rig& rig);

}  // namespace animeme::head::detail
