// Tables of align_table about texts that are not quite what is said.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/align_material.h"

namespace animeme::bench {

// Two sentences that differ from their text by a word: what is noticed, and what in vain.
void score_edits(const std::vector<Sentence>& sentences, const std::vector<double>& levels);

// All sentences behind each other for so many minutes, every 30th word missing in the text, and in
// the middle a minute that the text does not have.
void score_long(const std::vector<Sentence>& sentences, double minutes);

}  // namespace animeme::bench
