/// @file
/// Splits sentences into folds for cross-validation.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace animeme::tools {

/// The fold (from 0) of each sentence. Sentences with the same words are in the same fold;
/// otherwise folds are balanced. Independent of the order of the sentences. `folds` >= 1.
std::vector<int> split_into_folds(const std::vector<std::string>& ids,
                                  const std::vector<std::string>& texts, int folds);

/// Selects 15 to 30 % of the sentences that contain held-out words, which occur in no other
/// sentence, to test on untrained words. Empty: fewer than 20 sentences, or no such words.
std::vector<bool> hold_words_out(const std::vector<std::string>& texts);

}  // namespace animeme::tools
