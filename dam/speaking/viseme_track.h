/// @file
/// Speech as FAP 1: two visemes and a blend a frame, for players that know visemes only.
///
///     auto clip = dam::to_sequence(*dam::synthesise(model, script, settings));
///     dam::show_visemes(script, *clip, dam::VisemePlace::instead);
#pragma once

#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"

namespace animeme::dam {

/// FAP 1 for every frame of `clip`, which is what synthesise() has made of `script`: frames 0, 1, 2
/// ... with the jaw and the lips.
///
/// The players' shapes are not known, so each sound is shown by its own viseme, and how much of it
/// and of which neighbour says the motion of `clip`, in which the sounds are coarticulated: of the
/// visemes of the sounds that a frame lies in and beside, the two and their blend are chosen whose
/// measured shapes (fap/viseme.h) come nearest to the motion, in position and in speed, over the
/// whole clip at once (dynamic programming), so that nothing jumps where the pair changes. P, B, M,
/// F and V have a frame in which they are shown in full. A pair keeps its order while it lasts. HH
/// takes the viseme of the sound behind it. Deterministic; time is linear in the frames.
std::vector<fap::Viseme> viseme_track(const Script& script, const fap::Sequence& clip);

/// Where FAP 1 goes.
enum class VisemePlace : std::uint8_t {
  instead,  ///< of the jaw, the lips and the tongue, which are taken away
  beside,   ///< these stay; of such frames players show the one or the other
};

/// Puts viseme_track() into the frames of `clip`.
void show_visemes(const Script& script, fap::Sequence& clip, VisemePlace place);

}  // namespace animeme::dam
