/// @file
/// From words to the phones that the recogniser knows. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/align.h"

namespace animeme::voice {

using Labels = std::vector<std::string>;  ///< the 39 phones of the CMU dictionary

/// A word of the transcript with all ways to say it, none empty; no way if nobody knows one.
struct SpokenWord {
  std::string text;              ///< as the transcript spells it
  std::vector<Labels> variants;  ///< ARPAbet
  bool guessed = false;          ///< an English word that the dictionary lacks, spelled out by rule
};

/// Is it the language of the dictionary and of the model?
bool is_english(std::string_view language);

/// One for each word. Of those that a voice says nothing for, and of pictures, a warning tells.
/// Errors as align().
Result<std::vector<SpokenWord>> find_pronunciations(const std::vector<std::string>& words,
                                                    const AlignOptions& options,
                                                    std::vector<std::string>& warnings);

}  // namespace animeme::voice
