// From sentences to the numbers that are fitted. Internal to training.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus.h"
#include "dam/detail/speech_data.h"
#include "dam/model.h"
#include "dam/train.h"

namespace animeme::dam {

struct TrainingSet {
  SpeechData data;
  std::vector<Control> controls;
  std::vector<PhoneModel> phones;  ///< by label
  fap::Rate rate;
  double closure_gap = 0;  ///< see Model
  std::optional<double> lip_tooth_raise;
  std::vector<std::string> warnings;
};

/// Checks the sentences, takes statistics, standardises, cuts scripts into occurrences.
/// Frames that are not measured or lie in a long pause are marked as not used.
Result<TrainingSet> make_training_set(std::span<const Utterance* const> sentences,
                                      const TrainOptions& options);

}  // namespace animeme::dam
