/// @file
/// Do the scripts of a corpus belong to its motion, and are they in time?
#pragma once

#include <span>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "fap/result.h"

namespace animeme::dam {

/// The yardstick is the model that is built in: it speaks every script, and one linear map, learned
/// here by least squares, tells the corpus's controls, whatever they are, from five shapes of its
/// mouth (jaw, gap, width, upper lip, corners), at lags from -0.5 to 0.5 s.
///
/// - `fit` is what the map explains at the best lag; `chance` what maps explain that were learned
///   with scripts of other sentences. Less than six deviations between them, or less than
///   twice as much (of five sentences or more): `unrelated`.
/// - `lag`: where the correlation of motion and mapped shapes is highest, with an interval from
///   drawing sentences (stretches of a second if there are fewer than eight), 10 ms wider on both
///   sides as speakers differ. Not told with fewer than eight of these, or if the interval is wider
///   than 150 ms.
/// - `doubts`, of five sentences or more: those whose correlation is at most 0.6 of the usual, and
///   which reach 0.9 of it 0.1 s or more away (then with that shift), or follow a quarter of twelve
///   other scripts as well (then with none).
///
/// Sentences in any order give the same, as does any number of threads. They must have the same
/// controls. Errors: those of builtin_model().
Result<Alignment> check_alignment(std::span<const Utterance* const> sentences, int threads = 0);

/// The script `seconds` later (negative: earlier). Phones that end before 0 are dropped, the first
/// that is left begins at 0 if it is silence.
Script shifted_script(const Script& script, double seconds);

}  // namespace animeme::dam
