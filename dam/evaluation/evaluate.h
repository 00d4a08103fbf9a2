/// @file
/// Measures the error of synthesis against recorded motion. Source: dam/lipsync.md, section 8.
///
///     auto result = animeme::dam::evaluate(model, utterances);       // synthesise and score
///     auto pairs = animeme::dam::synthesise_pairs(model, utterances);
///     auto same = animeme::dam::score(*pairs, {.scale = model.controls});
///
/// score() accepts motion from anywhere: other systems, decoded streams.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/evaluation/scores.h"
#include "dam/model/model.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"

namespace animeme::dam {

/// Phone contexts and words of some scripts, sorted, each once.
struct SeenContexts {
  std::vector<std::string> triphones;  ///< "left phone right"; the end of a script is SIL
  std::vector<std::string> words;      ///< as written in the scripts

  /// False: nothing is counted as seen or unseen.
  bool known() const { return !triphones.empty(); }
};
/// For example those of the sentences that a model was trained on.
SeenContexts seen_contexts(std::span<const Utterance> utterances);

/// Options of score().
struct ScoreOptions {
  double closed_gap = 45;     ///< FAP units: inner gap below which lips count as closed
  double contact_slack = 45;  ///< FAP units: see ContactScore::level
  /// The controls to compare, with the mean and deviation that normalise errors (`rest` is not
  /// used). Empty: those of the first recording, with the statistics of the recordings' speech.
  std::vector<Control> scale;
  SeenContexts seen;  ///< of the training rows; empty: unknown
  int threads = 0;    ///< 0: number of cores; the result does not depend on it
};

/// Options of evaluate().
struct EvaluateOptions {
  SynthesisOptions synthesis;  ///< rate and frames are those of each recording
  ScoreOptions score;          ///< an empty scale is that of the model
};

/// A recording and the synthesised motion of its script.
struct SentencePair {
  Utterance recorded;  ///< script and measured signal
  Signal synthesised;  ///< same rate and number of frames; channels are found by name
};

/// Result of score(). Scored are measured frames within 0.2 s of speech, of the FAPs 3 to 13 and 51
/// to 60; of all controls that move, if the scale has none of these.
struct Evaluation : RegionScore {  ///< of the speech
  std::size_t utterances = 0;
  double seconds = 0;      ///< of scored frames
  RegionScore silence;     ///< measured frames further from speech; may be empty
  ClosureScore closure;    ///< P, B, M
  ContactScore contact;    ///< F, V
  RoundingScore rounding;  ///< rounded vowels and W
  TimingScore timing;      ///< lags
  DynamicsScore dynamics;  ///< mean over scored controls that move
  std::vector<DynamicsScore> series_dynamics;  ///< of `controls`, then of `measures`
  /// "jaw" FAP 3, "upper lip" 4, 8, 9, 51, 55, 56, "lower lip" 5, 10, 11, 52, 57, 58, "corners" 6,
  /// 7, 12, 13, 53, 54, 59, 60: means over those that are scored and move; groups without any are
  /// omitted.
  std::vector<DynamicsScore> group_dynamics;
  Breakdown breakdown;                        ///< by phone, viseme and seen contexts
  std::vector<UtteranceScore> per_utterance;  ///< in the order given
  /// Mean of UtteranceScore::gap_correlation: the similarity of the motion, independent of its
  /// size. The measure for speakers that the model does not know.
  double gap_correlation = 0;
};

/// The controls of the first recording with the statistics of all recordings' speech: the default
/// scale. All must have the controls of the first; empty if there is no recording.
std::vector<Control> recording_scale(std::span<const Utterance* const> recordings);

/// Compares. Deterministic, for any number of threads.
/// Errors: invalid_argument (no pair; nothing to score; a pair of different rate or length, or of
/// another rate than the first, with the sentence named), not_found (a control of the scale is
/// missing, likewise).
Result<Evaluation> score(std::span<const SentencePair> pairs, const ScoreOptions& options = {});

/// Synthesises every sentence at the rate and length of its recording, on several threads.
/// Errors: those of synthesise() with the sentence named.
Result<std::vector<SentencePair>> synthesise_pairs(const Model& model,
                                                   std::span<const Utterance> utterances,
                                                   const EvaluateOptions& options = {});

/// Both in one. Errors: those of the two.
Result<Evaluation> evaluate(const Model& model, std::span<const Utterance> utterances,
                            const EvaluateOptions& options = {});

/// True for FAP 3 to 13 and 51 to 60, by channel name.
bool is_scored_lip_fap(std::string_view name);

}  // namespace animeme::dam
