/// @file
/// Speech as FAP 1: two visemes and a blend per frame, for players that support visemes only.
///
///     auto clip = dam::to_sequence(*dam::synthesise(model, script, settings));
///     dam::show_visemes(script, *clip, dam::VisemePlace::instead);
#pragma once

#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"

namespace animeme::dam {

/// FAP 1 for every frame of `clip`, the output of synthesise() for `script`: frames 0, 1, 2 ...
/// with the jaw and the lips.
///
/// The shapes of players are unknown, so each sound is shown by its own viseme, and the motion of
/// `clip`, in which the sounds are coarticulated, determines its weight and that of a neighbour:
/// among the visemes of the sounds in and next to a frame, the two and their blend are chosen whose
/// measured shapes (fap/viseme.h) best approximate the motion, in position and in speed, and that
/// differ least from the weights of the sounds (viseme_curves.h), over the whole clip at once
/// (dynamic programming), so that nothing jumps where the pair changes. P, B, M,
/// F and V have a frame in which they are shown fully. A pair keeps its order while it lasts. HH
/// takes the viseme of the next sound. Deterministic; linear in the number of frames.
std::vector<fap::Viseme> viseme_track(const Script& script, const fap::Sequence& clip);

/// Placement of FAP 1.
enum class VisemePlace : std::uint8_t {
  instead,  ///< replaces the jaw, the lips and the tongue
  beside,   ///< these stay; players show one or the other in such frames
};

/// Puts viseme_track() into the frames of `clip`.
void show_visemes(const Script& script, fap::Sequence& clip, VisemePlace place);

}  // namespace animeme::dam
