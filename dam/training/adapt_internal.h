// The parts of adapt(): the base mapped to other controls, models added up, and what they are
// weighed by. Internal.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/accumulate.h"
#include "dam/training/adapt.h"

namespace animeme::dam {

/// The base with two more controls: 1 in speech and 1 in the silences next to it, 0 further away.
Model with_levels(const Model& base);
inline constexpr std::size_t kLevels = 2;

/// Own control c is offset[c] + sum over b of gain[c * base controls + b] times control b of the
/// base with levels. Where that rests, so does the own face.
struct Telling {
  std::vector<double> offset;
  std::vector<double> gain;
};

/// Least squares over the frames of speech of sentences and the base's output for them: levels of
/// speech and silence, and gains. A control that the base has by name has one gain: the ratio of
/// the deviations times a correlation that all controls of its articulator have in common. Others
/// are mixtures of all controls of the base, regularised towards 0. `base`: with levels; `own`: the
/// controls with their rest.
Telling tell_base(const Model& base, std::span<const Control> own,
                  std::span<const Utterance* const> sentences, std::span<const Signal* const> made,
                  std::vector<AdaptedControl>* found = nullptr);

/// The same curves for all phones of the base, which has the same dominance: phones that the model
/// lacks have the mean of its speech, and the terms of their class.
Model with_phones_of(const Model& base, const Model& model);

/// A part of an adapted model: a model under the base's dominance, whose control k has a share of
/// gain[c * its controls + k] in own control c. It has the phones of the base.
struct ModelShare {
  const Model* model = nullptr;
  std::vector<double> gain;
};

/// One model of all shares; `offset`: added to each control. `controls`: those of the own
/// recordings, with the rest that the model gets. What the parts and the offset amount to at rest,
/// more or less than that, is added to the curves of all phones: so a person's rest does not depend
/// on where speech is.
Model add_up(const Model& base, std::span<const ModelShare> shares, std::span<const double> offset,
             std::vector<Control> controls);

/// Training material, spoken by the base.
using Sentences = std::vector<const Utterance*>;
using Signals = std::vector<const Signal*>;

/// The own sentences, in an order that does not depend on how they were given, spoken by the base.
struct Material {
  std::vector<Utterance> sentences;  ///< with phones of the base
  std::vector<Signal> made;

  std::pair<Sentences, Signals> part(std::size_t fold, std::size_t folds, bool inside) const {
    std::pair<Sentences, Signals> out;
    for (std::size_t s = 0; s < sentences.size(); ++s) {
      if ((folds > 0 && s % folds == fold) != inside) continue;
      out.first.push_back(&sentences[s]);
      out.second.push_back(&made[s]);
    }
    return out;
  }
};

/// A script spoken as it was learned, without rules.
SynthesisOptions as_learned(const Signal& like);

/// What a mixture is made of.
struct Recipe {
  double own_ridge = 1;
  double bent_ridge = 0;      ///< of the curves on top of the bent base; 0: none
  std::vector<double> share;  ///< of the bent base in each control; the rest is of own curves
};

/// What mixtures are made of: the base with levels, own sentences, and their sums fold by fold.
struct Ingredients {
  const Model& base;
  const Material& material;
  std::span<const Control> controls;  ///< own ones
  std::vector<double> ridges;         ///< factors to try
  std::vector<TrainingSums> folds;
};

/// Sums of own controls and behind them those of the base as it speaks the sentences. Curves are
/// linear in what they are fitted to, so one solution serves every mixture of the two.
Result<std::vector<TrainingSums>> sums_of_folds(const Model& base, const Material& material,
                                                std::size_t folds, const TrainOptions& options);

/// The sums of all folds but one solved, for all phones of the base; `without` = number of folds:
/// all.
Result<TrainingSums> sums_without(const std::vector<TrainingSums>& folds, std::size_t without);
Result<Model> solved(const Model& base, const TrainingSums& sums, TrainOptions options,
                     double ridge);

/// Leaves sentences out in turn and chooses the mixture that has the least squared error on them,
/// offsets kept; the errors go to `report`. With one sentence: half and half.
Result<Recipe> choose_recipe(const Ingredients& from, const TrainOptions& options,
                             AdaptReport& report, const ProgressFunction& progress);

/// The model that a recipe makes of all sentences.
Result<Model> mixed_model(const Ingredients& from, const Recipe& recipe, const Telling& telling,
                          const TrainOptions& options);

}  // namespace animeme::dam
