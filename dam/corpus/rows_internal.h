// The list of sentences of a corpus, utterances.tsv, from memory.
#pragma once

#include <string_view>
#include <vector>

#include "dam/corpus/corpus.h"

namespace animeme::dam {

/// One entry a row that options.split_value asks for, with id, text and fields, without script and
/// signal. Ids are unique and can be parts of paths. Errors, with the line: those of
/// read_corpus() that this table may have.
Result<std::vector<Utterance>> parse_rows(std::string_view text, const CorpusOptions& options);

}  // namespace animeme::dam
