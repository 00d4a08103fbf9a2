/// @file
/// From words to the phones that the recogniser knows. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/readings.h"
#include "tools/speech/voice/align.h"

namespace animeme::voice {

using Labels = std::vector<std::string>;  ///< the 39 phones of the CMU dictionary

/// A word of the transcript with all ways to say it, none empty; no way if nobody knows one.
struct SpokenWord {
  std::string text;                        ///< as the transcript spells it
  std::vector<Labels> variants;            ///< ARPAbet; SIL between the words of a reading
  std::size_t complete = ~std::size_t(0);  ///< variants behind leave out the currency of an amount
  bool guessed = false;  ///< an English word that the dictionary lacks, spelled out by rule,
                         ///< or one with readings
};

/// Is it the language of the dictionary and of the model?
bool is_english(std::string_view language);

/// The most ways to say a word that the search compares.
inline constexpr std::size_t kMostVariants = 12;

/// One for each word. The ways to say one with readings are those of its readings: in English of
/// their words by the dictionary, else as a voice says them. Of those that a voice says nothing
/// for, and of pictures, a warning tells. Errors as align().
Result<std::vector<SpokenWord>> find_pronunciations(const std::vector<text::Token>& words,
                                                    const AlignOptions& options,
                                                    std::vector<std::string>& warnings);

}  // namespace animeme::voice
