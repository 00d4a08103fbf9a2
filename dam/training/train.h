/// @file
/// Training of a model from recorded sentences. Source: the paper, section V; dam/lipsync.md,
/// sections 1 to 7.
#pragma once

#include <span>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// Trains on all given sentences. They must have the same controls and rate. The result is
/// bit-identical for any number of threads and any order of the sentences. Memory: about 30 MB + 8
/// bytes * (modes * (order + 1))^2 * 8; mmm and triphone: about 1 kB per second of speech and
/// control. What only the summary tells (errors on held-out sentences, outliers, alignment) is not
/// computed without one. Errors: invalid_argument (options, no sentence, no speech, cancelled, NaN
/// in a signal, different controls).
Result<Model> train(std::span<const Utterance> utterances, const TrainOptions& options = {},
                    TrainSummary* summary = nullptr, const ProgressFunction& progress = {});

}  // namespace animeme::dam
