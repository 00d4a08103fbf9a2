/// @file
/// Report on an adaptation, as text and JSON.
#pragma once

#include <string>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/training/adapt.h"

namespace animeme::inspect {

/// The complete report as JSON text. `output` is the model file, `base` the user's name of the base
/// model, `left_out` what was excluded from the corpus.
std::string adaptation_json(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report,
                            const dam::LeftOut& left_out = {});

/// The report as text: sentences, results of base and own curves, controls that the base does not
/// predict. No line end after the last line.
std::string adaptation_text(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report);

}  // namespace animeme::inspect
