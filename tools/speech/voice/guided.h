/// @file
/// Phones that are heard with words in mind. Internal. Source: tools/speech/voice/engines.md,
/// section 3.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tools/speech/voice/hearing.h"
#include "tools/speech/voice/word_search.h"

namespace animeme::voice {

/// Where a path may be cut: in the middle of the longest pause in its later part, before frame
/// `most`; there if it has none.
std::size_t cut_in_pause(const HearingModel& model, const Path& path, std::size_t most);

/// A word with the phone of each of its frames.
struct WordPath {
  FoundWord word;                   ///< `belief` is that of judge_words()
  std::vector<std::size_t> phones;  ///< numbers in SoundModel::phones
};

/// Where the phones of the words are, and how much each word is believed, 0..1: by the search, by
/// the votes of the phones alone, and by whether the words of the piece make a sentence. Words of
/// phones that the model lacks are left out.
std::vector<WordPath> judge_words(const HearingModel& model,
                                  std::span<const std::vector<float>> scores, const Votes& votes,
                                  std::vector<FoundWord> words);

/// Adds to the scores of each frame what the words say of it.
void lean_on_words(const std::vector<WordPath>& words, std::vector<std::vector<float>>& scores);

}  // namespace animeme::voice
