/// @file
/// What came of a corpus, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/characters/capture/build_corpus.h"
#include "tools/formats/common/json.h"

namespace animeme::tools {

/// A few lines, and one for each sentence or file that wants a look.
std::string report_text(const CorpusReport& report);
/// Everything.
Json report_json(const CorpusReport& report);

/// utterances.tsv; `held_out`: hold_words_out().
std::string utterance_table(const std::vector<SentenceReport>& sentences,
                            const std::vector<bool>& held_out, int folds);

/// The words of a script, in their order.
std::string words_of_script(const dam::Script& script);

}  // namespace animeme::tools
