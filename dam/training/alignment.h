/// @file
/// Checks whether the scripts of a corpus match its motion, and whether they are in sync.
#pragma once

#include <span>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "fap/result.h"

namespace animeme::dam {

/// The reference is the built-in model: it speaks every script, and one linear map, learned here by
/// least squares, predicts the controls of the corpus, whatever they are, from five shapes of its
/// mouth (jaw, gap, width, upper lip, corners), at lags from -0.5 to 0.5 s.
///
/// - `fit` is the share explained by the map at the best lag; `chance` the share explained by maps
///   learned with scripts of other sentences. If they differ by less than six deviations, or by
///   less than a factor of two (with five sentences or more): `unrelated`.
/// - `lag`: where the correlation of motion and mapped shapes is highest, with an interval by
///   bootstrap over sentences (stretches of a second if there are fewer than eight), 10 ms wider on
///   both sides as speakers differ. Not reported with fewer than eight of these, or if the interval
///   is wider than 150 ms.
/// - `doubts`, with five sentences or more: those whose correlation is at most 0.6 of the usual,
///   and which either reach 0.9 of it with a shift of 0.1 s or more (reported with that shift), or
///   follow a quarter of twelve other scripts equally well (without shift).
///
/// The result does not depend on the order of the sentences or the number of threads. They must
/// have the same controls. Errors: those of builtin_model().
Result<Alignment> check_alignment(std::span<const Utterance* const> sentences, int threads = 0);

/// The script shifted by `seconds` (negative: earlier). Phones that end before 0 are dropped; the
/// first remaining one begins at 0 if it is silence.
Script shifted_script(const Script& script, double seconds);

}  // namespace animeme::dam
