/// @file
/// What `train` prints of a training, as text and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "dam/model/model.h"
#include "dam/training/train.h"

namespace animeme::tools {

/// Everything of the summary that has a meaning for the model's method.
nlohmann::ordered_json train_json(const std::string& output, const dam::Model& model,
                                  const dam::TrainSummary& summary);

/// Lines of talk: size, steps, ridge, what is explained, phones that others stand in for. Warnings
/// are printed as such. `seconds` of the corpus, 0: not known.
void say_training(const std::string& output, const dam::Model& model,
                  const dam::TrainSummary& summary, double seconds);

}  // namespace animeme::tools
