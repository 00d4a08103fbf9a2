/// @file
/// From words to the phones that the recogniser knows. Internal.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/voice/align.h"

namespace animeme::voice {

using Labels = std::vector<std::string>;  ///< the 39 phones of the CMU dictionary

/// A word of the transcript with all ways to say it, at least one, none empty.
struct SpokenWord {
  std::string text;              ///< as the transcript spells it
  std::vector<Labels> variants;  ///< ARPAbet
};

/// Words that a voice says nothing for are left out, with a warning. Errors as align().
Result<std::vector<SpokenWord>> find_pronunciations(const std::vector<std::string>& words,
                                                    const AlignOptions& options,
                                                    std::vector<std::string>& warnings);

}  // namespace animeme::voice
