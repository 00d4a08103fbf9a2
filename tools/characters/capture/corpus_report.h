/// @file
/// Report on a corpus, as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/characters/capture/build_corpus.h"
#include "tools/formats/common/json.h"

namespace animeme::tools {

/// A summary, and a line for each sentence or file that should be checked.
std::string report_text(const CorpusReport& report);
/// The complete report.
Json report_json(const CorpusReport& report);

/// utterances.tsv; `held_out`: hold_words_out().
std::string utterance_table(const std::vector<SentenceReport>& sentences,
                            const std::vector<bool>& held_out, int folds);

/// The words of a script, in their order.
std::string words_of_script(const dam::Script& script);

}  // namespace animeme::tools
