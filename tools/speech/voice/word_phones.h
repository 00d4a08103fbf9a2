/// @file
/// Converts timed words (from recognisers, subtitles, speech services) to phones, by their
/// pronunciation and the usual durations of phones.
#pragma once

#include <string>
#include <vector>

#include "dam/script/timings.h"
#include "fap/result.h"
#include "tools/speech/voice/align.h"

namespace animeme::voice {

/// Replaces word labels by their phones; several words in one label share its time. Pronunciations
/// are those of align(): the dictionary for English if it is installed, else a voice of
/// `options.language`. Times inside a word are estimated: dam::spread_phones(). A word without a
/// pronunciation ("-") becomes silence, with a warning.
///
/// Errors: those of pronounce() and of align() about pronunciations; syntax, with its place (a word
/// that does not end after its start); out_of_range (more than 1 MB of words).
Result<dam::Timings> words_to_phones(const dam::Timings& timings, const AlignOptions& options,
                                     std::vector<std::string>& warnings);

}  // namespace animeme::voice
