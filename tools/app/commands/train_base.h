/// @file
/// `train --base`, and what of `train` other commands do, too.
#pragma once

#include <string>
#include <vector>

#include "dam/training/train.h"
#include "tools/app/commands/corpus.h"

namespace animeme::tools {

/// The names of all methods, for --method.
std::vector<std::string> method_names();

/// A base as users name it: "builtin", a model file, or a folder with a corpus, on which a model is
/// trained, with the controls of `like` if it has them.
Result<dam::Model> load_base(const std::string& base, const CorpusSettings& like,
                             const dam::TrainOptions& train);

/// Bends a base to the sentences of a corpus and writes the model; the exit code.
Result<int> train_on_base(const std::string& base, const CorpusSettings& corpus,
                          const std::string& output, const dam::TrainOptions& train, bool json);

}  // namespace animeme::tools
