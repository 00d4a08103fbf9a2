/// @file
/// Sentences into parts, so that each is tested on by models that never saw it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace animeme::tools {

/// The part (0 ...) of each sentence. The same words are always in one part, whoever says them how
/// often; parts have as many sentences as that lets them. The same sentences give the same parts,
/// in whatever order they come. `folds` >= 1.
std::vector<int> split_into_folds(const std::vector<std::string>& ids,
                                  const std::vector<std::string>& texts, int folds);

/// Which sentences have one of some words that no other sentence has: 15 to 30 % of them, to test
/// on words that were never trained. Empty: there are fewer than 20 sentences, or no such words.
std::vector<bool> hold_words_out(const std::vector<std::string>& texts);

}  // namespace animeme::tools
