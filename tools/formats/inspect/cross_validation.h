/// @file
/// How good a kind of training is on sentences it has not seen: each is spoken by a model that was
/// trained without it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/evaluation/evaluate.h"
#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::inspect {

/// What cross_validate() does.
struct CrossValidation {
  std::size_t folds = 5;             ///< 2 or more; no more than there are sentences count
  dam::TrainOptions train;           ///< of every model
  const dam::Model* base = nullptr;  ///< bent to the sentences by dam::adapt(); none: dam::train()
  dam::EvaluateOptions evaluate;     ///< how the sentences are spoken
  /// Gets the share that is done, 0..1, and returns false to stop.
  std::function<bool(double)> progress;
};

/// The sentences, ordered by id, with what was made for them: sentence s is left out, with every
/// `folds`-th one from it, of the training of the model that speaks it. Deterministic; any order of
/// the sentences gives the same. Errors: invalid_argument (fewer than two sentences or folds,
/// stopped), those of dam::train(), dam::adapt() and dam::synthesise_pairs().
Result<std::vector<dam::SentencePair>> cross_validate(std::span<const dam::Utterance> sentences,
                                                      const CrossValidation& options);

}  // namespace animeme::inspect
