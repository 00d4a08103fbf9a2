/// @file
/// Words whose times are known become phones: what a recogniser, subtitles or a speech service say,
/// by the pronunciation of each word and the usual lengths of its sounds.
#pragma once

#include <string>
#include <vector>

#include "dam/script/timings.h"
#include "fap/result.h"
#include "tools/speech/voice/align.h"

namespace animeme::voice {

/// Labels that are words are replaced by their phones; several words of one label share its time.
/// Pronunciations are those of align(): the dictionary for English if it is installed, else a voice
/// of `options.language`. Times inside a word are a guess: dam::spread_phones(). A word that
/// nothing is said for ("-") becomes silence, with a warning.
///
/// Errors: those of pronounce() and of align() about pronunciations; syntax, with its place (a word
/// that does not end after its start).
Result<dam::Timings> words_to_phones(const dam::Timings& timings, const AlignOptions& options,
                                     std::vector<std::string>& warnings);

}  // namespace animeme::voice
