/// @file
/// What a training has found, as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "dam/model/model.h"
#include "dam/training/train.h"

namespace animeme::inspect {

/// What a model was made from.
struct TrainingData {
  double seconds = 0;              ///< of the corpus
  std::vector<std::string> parts;  ///< files of sums in place of a corpus; seconds is 0 then
  dam::LeftOut left_out = {};      ///< of the corpus
};

/// How scripts and motion belong together, as JSON text.
std::string alignment_json(const dam::Alignment& alignment);

/// Everything of the summary that has a meaning for the model's method, as JSON text. `output` is
/// the file of the model.
std::string training_json(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data);

/// Lines of talk: size, steps, ridge, what is explained; not the warnings. No line end behind the
/// last one.
std::string training_text(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data);

/// The phones that the data lack with those that stand in for them, in one line; empty: none.
std::string ties_text(const dam::TrainSummary& summary);

}  // namespace animeme::inspect
