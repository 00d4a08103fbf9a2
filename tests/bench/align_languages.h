// Tables of align_table about languages that have no corpus here.
#pragma once

#include <cstddef>
#include <string>

#include "fap/result.h"

namespace animeme::bench {

// Which recordings, of which language.
struct LanguageRows {
  std::string language = "en";
  std::size_t every = 1, from = 0;
};

// How far words and phones are from the labels of a folder that festival_corpus.sh made. Phones are
// compared one by one in words that have as many of them here as there.
Result<void> score_labelled(const std::string& folder, const LanguageRows& rows);

// The same for the sentences of a list, said by espeak-ng: all phones are compared, as text and
// voice have the same ones.
Result<void> score_spoken(const std::string& list, const LanguageRows& rows);

// Recordings without times (recorded_lists.h): what is refused and doubted in right texts, what is
// noticed in wrong ones.
Result<void> score_recorded(const std::string& folder, const std::string& list,
                            const LanguageRows& rows);

}  // namespace animeme::bench
