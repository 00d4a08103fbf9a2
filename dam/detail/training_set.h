// From sentences to the numbers that are fitted. Internal to training.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/corpus.h"
#include "dam/detail/speech_data.h"
#include "dam/detail/timeline.h"
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
};

/// Checks one sentence: the controls and the rate of `first`, complete frames of finite numbers, a
/// valid script. Errors name the sentence.
Result<void> check_sentence(const Utterance& sentence, const std::vector<std::string>& names,
                            fap::Rate rate);

/// Appends a sentence to set.data: targets by set.controls, occurrences by set.phones. Frames that
/// are not measured or lie in a long pause are marked as not used.
void add_sentence(const Utterance& sentence, const std::vector<Occurrence>& timeline,
                  double pause_edge, TrainingSet& set);

/// Index of a label in phones sorted by label, which must have it; kRestContext for "".
std::int32_t index_of(const std::vector<PhoneModel>& phones, const std::string& label);

/// The class of a label, as PhoneModel::context_class.
std::uint32_t context_class_of(std::string_view label);

/// Seconds: nothing shorter is drawn out; PhoneModel::longest is at least this.
inline constexpr double kLongestAnyway = 0.3;

/// Checks the sentences, takes statistics, standardises, cuts scripts into occurrences.
/// Frames that are not measured or lie in a long pause are marked as not used.
Result<TrainingSet> make_training_set(std::span<const Utterance* const> sentences,
                                      const TrainOptions& options);

}  // namespace animeme::dam
