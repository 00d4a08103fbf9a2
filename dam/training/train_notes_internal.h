// Warnings of training about the data, for TrainSummary. Internal.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/model/model.h"

namespace animeme::dam {

/// Sentences are left out in turn in so many parts.
inline constexpr std::size_t kFolds = 4;

/// Sentences by their identifiers: the order in which they are given must not matter.
std::vector<const Utterance*> sorted_sentences(std::span<const Utterance> utterances);

/// What of these wants attention, in sentences.
std::vector<std::string> warnings_of(const Alignment& alignment, std::span<const Glitch> glitches);

/// Rare phones and those that are not there.
void note_phones(const Model& model, TrainSummary& summary);

/// One sentence beside what a model makes of its script, per control, in deviations.
struct Review {
  double frames = 0;
  std::vector<double> offset;  ///< mean of recorded - made
  std::vector<double> error;   ///< sum of squares around that
  std::vector<double> energy;  ///< sum of squares of the recorded around their mean
};

/// TrainSummary::controls from sentences that their models had not seen.
class HeldOutShare {
 public:
  /// Sentences with phones that the model cannot say are left out.
  void add(const Model& model, std::span<const Utterance* const> sentences, int threads);
  /// Nothing was added: it stays unknown.
  void note(std::span<const Control> controls, TrainSummary& summary) const;

 private:
  std::vector<Review> reviews_;
};

/// Speaks the training sentences with the finished model and compares: sentences that stand out,
/// and what is explained, unless that is known of sentences held out.
void review_sentences(const TrainingSet& set, const Model& model,
                      std::span<const Utterance* const> sentences, int threads,
                      TrainSummary& summary);

/// Puts all notes into sentences.
void add_warnings(TrainSummary& summary);

}  // namespace animeme::dam
