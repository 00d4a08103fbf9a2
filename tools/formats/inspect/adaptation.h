/// @file
/// What an adaptation has found, as text and JSON.
#pragma once

#include <string>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/training/adapt.h"

namespace animeme::inspect {

/// Everything of the report, as JSON text. `output` is the file of the model, `base` what the user
/// calls the base, `left_out` what the corpus had that was not read.
std::string adaptation_json(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report,
                            const dam::LeftOut& left_out = {});

/// Lines of talk: sentences, what base and own curves come to, controls that the base does not
/// tell. No line end behind the last one.
std::string adaptation_text(const std::string& output, const std::string& base,
                            const dam::Model& model, const dam::AdaptReport& report);

}  // namespace animeme::inspect
