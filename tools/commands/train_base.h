/// @file
/// `train --base`.
#pragma once

#include <string>

#include "dam/training/train.h"
#include "tools/commands/corpus.h"

namespace animeme::tools {

/// Bends a base to the sentences of a corpus and writes the model; the exit code. `base`:
/// "builtin", a model file, or a folder with a corpus, on which a model is trained first.
Result<int> train_on_base(const std::string& base, const CorpusSettings& corpus,
                          const std::string& output, const dam::TrainOptions& train, bool json);

}  // namespace animeme::tools
