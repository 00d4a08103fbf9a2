/// @file
/// Report on a training, as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "dam/model/model.h"
#include "dam/training/train.h"

namespace animeme::inspect {

/// Training data of a model.
struct TrainingData {
  double seconds = 0;              ///< of the corpus
  std::vector<std::string> parts;  ///< files of sums instead of a corpus; then seconds is 0
  dam::LeftOut left_out = {};      ///< of the corpus
};

/// Alignment of scripts and motion, as JSON text.
std::string alignment_json(const dam::Alignment& alignment);

/// The parts of the summary that apply to the model's method, as JSON text. `output` is the model
/// file.
std::string training_json(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data);

/// The report as text: size, steps, ridge, explained variance, without the warnings. No line end
/// after the last line.
std::string training_text(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data);

/// The phones that are missing in the data, with their substitutes, in one line; empty: none.
std::string ties_text(const dam::TrainSummary& summary);

}  // namespace animeme::inspect
