// What training tells its user about the data: for TrainSummary. Internal.
#pragma once

#include <span>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/model/model.h"

namespace animeme::dam {

/// Rare phones and those that are not there.
void note_phones(const Model& model, TrainSummary& summary);

/// Speaks the training sentences with the finished model and compares: sentences that stand out,
/// and what is explained, unless that is known of sentences held out.
void review_sentences(const TrainingSet& set, const Model& model,
                      std::span<const Utterance* const> sentences, int threads,
                      TrainSummary& summary);

/// Puts all notes into sentences.
void add_warnings(TrainSummary& summary);

}  // namespace animeme::dam
