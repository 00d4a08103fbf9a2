// Are sound and face in time?
#pragma once

#include "dam/corpus/speech_data_internal.h"

namespace animeme::dam {

/// Seconds by which the signal comes after its labels (negative: before), from how well phones fit
/// when all are moved by -120 to 120 ms. Rough: widths and neighbours take up a part of a true lag.
/// `phones` is the number of phones that occurrences refer to.
double estimate_lag(const SpeechData& speech, std::size_t phones, int threads);

}  // namespace animeme::dam
