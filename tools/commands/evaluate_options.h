/// @file
/// Options of evaluate.
#pragma once

#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "tools/commands/corpus.h"
#include "tools/commands/face_stream.h"

namespace CLI {
class App;
}  // namespace CLI

namespace animeme::tools {

/// What was said on the command line.
struct EvaluateOptions {
  std::string system;  // with --tracks alone: the corpus
  std::string tracks;
  CorpusSettings corpus;
  std::string seen_split;
  int folds = 0;  // 0: a system that is there
  std::string method = "dam";
  std::string base;
  std::vector<std::string> controls;
  dam::EvaluateOptions evaluate;
  bool no_closure = false;
  std::string against;
  int draws = 1000;
  bool codec = false;
  StreamSettings stream;
  std::string picture;
  std::string report;
  bool json = false;
  bool full = false;
  double max_nrmse = -1;
  double min_closed = -1;
  double max_false = -1;
};

/// Adds them.
void add_options(CLI::App& app, EvaluateOptions& options);

/// Runs the command with them.
Result<int> run(const EvaluateOptions& options);

}  // namespace animeme::tools
