// Speech for the benchmarks of the models: sentences of words that the sample corpus has, spoken by
// the built-in model, with the noise and the offsets of a tracker, for any number of controls.
#pragma once

#include <cstddef>
#include <vector>

#include "dam/corpus/corpus.h"

namespace animeme::bench {

/// Sentences of about three seconds at 25 frames a second, `seconds` in all. The same every time.
std::vector<dam::Utterance> made_up_speech(double seconds, std::size_t controls);

/// The sample corpus that ships with the tests.
dam::Corpus sample_corpus();

}  // namespace animeme::bench
