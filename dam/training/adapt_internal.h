// The two halves of adapt(): the base mapped to other controls, and models added up. Internal.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/training/adapt.h"

namespace animeme::dam {

/// Own control c is offset[c] + sum over b of gain[c * base controls + b] times control b of the
/// base.
struct Telling {
  std::vector<double> offset;
  std::vector<double> gain;
};

/// Least squares over the frames of speech of sentences and the base's output for them. A control
/// that the base has by name has one gain, regularised towards 1; others are mixtures of all
/// controls of the base, regularised towards 0.
Telling tell_base(const Model& base, std::span<const Utterance* const> sentences,
                  std::span<const Signal* const> made,
                  std::vector<AdaptedControl>* found = nullptr);

/// The residual of a sentence without the mapped base, under placeholder names.
Signal rest_of(const Signal& own, const Signal& made, const Telling& telling);

/// One model for both parts. `controls`: those of the own recordings, with their statistics; their
/// rest is set here. `more`: a model of what rest_of() left, with a part of the base's phones and
/// the base's dominance; none: the base alone.
Model add_up(const Model& base, const Telling& telling, std::vector<Control> controls,
             const Model* more);

}  // namespace animeme::dam
