/// @file
/// `train --accumulate`, `train --merge` and `train --mpi`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dam/training/train.h"
#include "tools/app/commands/corpus.h"
#include "tools/formats/inspect/training.h"

namespace animeme::tools {

/// The options of training in parts.
struct PartSettings {
  std::string accumulate;          ///< file of sums to begin or to continue
  std::string dominance;           ///< model for the dominance; empty: start values
  std::size_t save_every = 200;    ///< sentences
  std::vector<std::string> merge;  ///< files of sums
  bool mpi = false;                ///< sums of all processes that mpirun started
};

/// Says, or prints as JSON, what a training has found.
void tell_training(const std::string& output, const dam::Model& model,
                   const dam::TrainSummary& summary, const inspect::TrainingData& data, bool json);

/// `train --accumulate`; the exit code.
Result<int> accumulate(const PartSettings& parts, const CorpusSettings& corpus,
                       const dam::TrainOptions& train, bool json);

/// `train --merge`; the exit code.
Result<int> merge(const PartSettings& parts, const std::string& output,
                  const CorpusSettings& corpus, dam::TrainOptions train, bool json);

/// `train --mpi`; the exit code.
Result<int> train_over_mpi(const PartSettings& parts, const std::string& output,
                           CorpusSettings corpus, dam::TrainOptions train, bool json);

}  // namespace animeme::tools
