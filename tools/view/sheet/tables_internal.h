// Parts of a sheet as HTML. Internal.
#pragma once

#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "dam/model/model.h"

namespace animeme::sheet {

/// Escaped for HTML.
std::string safe(const std::string& text);

/// The figures that people ask for first, each with a sentence of what it says.
std::string figures(const dam::Evaluation& evaluation);

/// Bars of error by sound, the largest first; what training had few examples of is marked. `model`
/// may be nothing.
std::string sounds(const dam::Evaluation& evaluation, const dam::Model* model);

/// Error, likeness and liveliness of each control.
std::string controls(const dam::Evaluation& evaluation);

/// The sentences with the largest errors, with what is said in them.
std::string sentences(const dam::Evaluation& evaluation,
                      const std::vector<dam::SentencePair>& pairs);

}  // namespace animeme::sheet
