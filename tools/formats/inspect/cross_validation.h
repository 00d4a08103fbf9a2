/// @file
/// Cross-validation of a training: each sentence is synthesised by a model that was trained without
/// it.
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

/// Options of cross_validate().
struct CrossValidation {
  std::size_t folds = 5;             ///< 2 or more; limited to the number of sentences
  dam::TrainOptions train;           ///< for every model
  const dam::Model* base = nullptr;  ///< base of dam::adapt(); nullptr: dam::train()
  dam::EvaluateOptions evaluate;     ///< how the sentences are spoken
  /// Receives the progress, 0..1; returns false to stop.
  std::function<bool(double)> progress;
};

/// Returns the sentences, ordered by id, with their synthesised motion: the model for sentence s is
/// trained without s and every `folds`-th sentence from it. Deterministic and independent of the
/// order of the sentences. Errors: invalid_argument (fewer than two sentences or folds, stopped),
/// those of dam::train(), dam::adapt() and dam::synthesise_pairs().
Result<std::vector<dam::SentencePair>> cross_validate(std::span<const dam::Utterance> sentences,
                                                      const CrossValidation& options);

}  // namespace animeme::inspect
