// What rank_methods prints about single controls.
#pragma once

#include <span>
#include <string>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "dam/evaluation/evaluate.h"
#include "fap/result.h"

namespace animeme::bench {

/// Trains a model for each control alone, with modes and widths of its own, as the paper does, and
/// scores their common output in the scale of `shared`, which was trained on all controls at once.
/// Nothing closes the lips, since no model has both.
Result<dam::Evaluation> evaluate_per_control(const dam::Model& shared,
                                             std::span<const dam::Utterance> train,
                                             std::span<const dam::Utterance> test,
                                             const dam::TrainOptions& options,
                                             const dam::EvaluateOptions& scoring);

/// A row of Markdown: the speed of the synthesised motion as a share of the recorded one, by
/// articulator. Corners are split into width (FAP 6, 7, 53, 54) and height (12, 13, 59, 60).
std::string velocity_row(const std::string& name, const dam::Evaluation& evaluation);
/// The head of its table.
std::string velocity_head();

}  // namespace animeme::bench
