// Corpora for the commands that need them.
#pragma once

#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "tools/commands/common.h"

namespace animeme::tools {

/// Where the rows of a corpus come from.
struct CorpusSettings {
  std::string folder;
  std::string split;
  std::string split_column = "split";
  std::string controls_folder = "fap";
  std::vector<std::string> controls;
  bool skip_missing = false;
};

/// Adds --split-column, --controls-folder and --skip-missing.
void add_corpus_options(CLI::App& app, CorpusSettings& settings);

/// "3-13", "51" and names such as "jawOpen" to channel names ("fap3_open_jaw" ...).
Result<std::vector<std::string>> control_names(const std::vector<std::string>& items);

Result<dam::Corpus> read_corpus(const CorpusSettings& settings);
/// One sentence at a time; returns how many rows were left out.
Result<std::size_t> visit_corpus(const CorpusSettings& settings, const dam::SentenceVisitor& visit);

}  // namespace animeme::tools
