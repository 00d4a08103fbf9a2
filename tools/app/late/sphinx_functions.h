/// @file
/// What animeme_sphinx.so has: those functions of tools/speech/voice that pocketsphinx and speexdsp
/// do the work of.
#pragma once

#include "tools/speech/voice/cepstra.h"
#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/rate_change.h"
#include "tools/speech/voice/word_search.h"

namespace animeme::voice {

struct SphinxFunctions {
  decltype(&CepstraReader::open) open_cepstra;
  decltype(&voice::read_phone_pairs) read_phone_pairs;
  decltype(&voice::denoise) denoise;
  decltype(&RateChange::open) open_rate_change;
  decltype(&WordSearch::open) open_word_search;
};

}  // namespace animeme::voice
