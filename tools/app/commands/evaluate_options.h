/// @file
/// Options of evaluate.
#pragma once

#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "tools/app/commands/corpus.h"
#include "tools/app/commands/face_stream.h"

namespace animeme::tools {

/// What was said on the command line.
struct EvaluateOptions {
  std::string system;                 ///< the model; with --tracks alone: the corpus
  std::string tracks;                 ///< --tracks
  CorpusSettings corpus;              ///< the corpus and --split, --lag ...
  std::string seen_split;             ///< --seen-split
  int folds = 0;                      ///< --folds; 0: a system that is there
  std::string method = "dam";         ///< --method
  std::string base;                   ///< --base
  std::vector<std::string> controls;  ///< --controls
  std::string speakers;               ///< --speakers: a corpus to warp
  std::vector<std::string> sizes = {"5", "10", "20"};  ///< --sentences
  int copies = 8;                                      ///< --copies
  int base_sentences = 0;                              ///< --base-sentences
  dam::EvaluateOptions evaluate;                       ///< --closed-gap, --sharpness, --articulate
  bool no_closure = false;                             ///< --no-closure
  std::string against;                                 ///< --against
  int draws = 1000;                                    ///< --draws
  bool rules = false;                                  ///< --rules
  bool codec = false;                                  ///< --codec
  StreamSettings stream;                               ///< --quant, --rms, --kbps
  std::string picture;                                 ///< --picture
  std::string report;                                  ///< --report
  bool json = false;                                   ///< --json
  bool full = false;                                   ///< --full
  double max_nrmse = -1;                               ///< --max-nrmse; below 0: any
  double min_closed = -1;                              ///< --min-closed; below 0: any
  double max_false = -1;                               ///< --max-false-per-minute; below 0: any
};

/// Adds them.
void add_options(OptionTable& cli, EvaluateOptions& options);

/// Runs the command with them.
Result<int> run(const EvaluateOptions& options);

}  // namespace animeme::tools
