/// @file
/// Corpora for the commands that need them.
#pragma once

#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "tools/commands/common.h"

namespace animeme::tools {

/// Where the rows of a corpus come from.
struct CorpusSettings {
  std::string folder;                   ///< of utterances.tsv
  std::string split;                    ///< value in the split column; empty: all rows
  std::string split_column = "split";   ///< column of utterances.tsv
  std::string controls_folder = "fap";  ///< with ID.csv or ID.fap
  std::vector<std::string> controls;    ///< channel names; empty: all
  std::string limits;         ///< table of limits; empty: limits.tsv of the folder, if it is there
  bool skip_missing = false;  ///< leave out rows without a file
};

/// Adds --split-column, --controls-folder and --skip-missing.
void add_corpus_options(CLI::App& app, CorpusSettings& settings);

/// "3-13", "51" and names such as "jawOpen" to channel names ("fap3_open_jaw" ...).
Result<std::vector<std::string>> control_names(const std::vector<std::string>& items);

/// Limits of the controls of a model from a table (dam::read_limits()): settings.limits, else
/// limits.tsv of the corpus folder if it has one. Without any, the model keeps its own.
Result<void> set_limits(const CorpusSettings& settings, dam::Model& model);

Result<dam::Corpus> read_corpus(const CorpusSettings& settings);  ///< all sentences at once
/// One sentence at a time; returns how many rows were left out.
Result<std::size_t> visit_corpus(const CorpusSettings& settings, const dam::SentenceVisitor& visit);

}  // namespace animeme::tools
