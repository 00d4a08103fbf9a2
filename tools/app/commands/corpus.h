/// @file
/// Corpora for the commands that need them.
#pragma once

#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "tools/app/commands/common.h"

namespace animeme::tools {

/// Where the rows of a corpus come from.
struct CorpusSettings {
  std::string folder;                   ///< of utterances.tsv
  std::string split;                    ///< value in the split column; empty: all rows
  std::string split_column = "split";   ///< column of utterances.tsv
  std::string controls_folder = "fap";  ///< with ID.csv or ID.fap
  std::vector<std::string> controls;    ///< channel names; empty: all
  std::string limits;         ///< table of limits; empty: limits.tsv of the folder, if it is there
  std::string lag;            ///< "auto" or milliseconds by which scripts are shifted; empty: none
  bool skip_missing = false;  ///< leave out rows without a file
  int shard = 1;              ///< visit_corpus(): only this part, from 1
  int shards = 1;             ///< of so many
};

/// Adds --split-column, --controls-folder and --skip-missing.
void add_corpus_options(OptionTable& cli, CorpusSettings& settings);

/// Adds --lag.
void add_lag_option(OptionTable& cli, CorpusSettings& settings);

/// "3-13", "51" and names such as "jawOpen" to channel names ("fap3_open_jaw" ...).
Result<std::vector<std::string>> control_names(const std::vector<std::string>& items);

/// Limits of the controls of a model from a table (dam::read_limits()): settings.limits, else
/// limits.tsv of the corpus folder if it has one. Without any, the model keeps its own.
Result<void> set_limits(const CorpusSettings& settings, dam::Model& model);

/// All sentences at once, with their scripts shifted by the lag. Says what is left out.
Result<dam::Corpus> read_corpus(const CorpusSettings& settings);
/// One sentence at a time; the lag is none or a number. Says and returns what is left out.
Result<dam::LeftOut> visit_corpus(const CorpusSettings& settings,
                                  const dam::SentenceVisitor& visit);

}  // namespace animeme::tools
