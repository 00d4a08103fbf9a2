// From sentences to the numbers that are fitted. Internal to training.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/speech_data_internal.h"
#include "dam/corpus/train_options.h"
#include "dam/model/model.h"
#include "dam/script/timeline_internal.h"

namespace animeme::dam {

struct TrainingSet {
  SpeechData data;
  std::vector<Control> controls;
  std::vector<PhoneModel> phones;              ///< by label
  std::map<std::string, std::uint32_t> words;  ///< numbers of SpeechData::word, from 1
  fap::Rate rate;
  double closure_gap = 0;  ///< see Model
  std::optional<double> lip_tooth_raise;
  std::optional<ClosureDuration> closure_duration;
};

/// A training run as a kind sees it: what it may report to.
struct TrainRun {
  TrainSummary& summary;
  const ProgressFunction& progress;
  bool explain = true;  ///< somebody reads what the summary says about sentences and controls

  /// False if the user wants to stop; then return cancelled().
  bool report(const char* stage, double done, double objective = 0) const {
    return !progress || progress(Progress{stage, done, objective});
  }
  static Error cancelled() { return make_error(Code::invalid_argument, "training was cancelled"); }
};

/// TrainSummary::controls from shares per control.
void note_explained(std::span<const Control> controls, const std::vector<double>& explained,
                    bool held_out, TrainSummary& summary);

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
