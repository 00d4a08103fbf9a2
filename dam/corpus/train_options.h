/// @file
/// Options, progress and results of training. Here, below the kinds of models, because all kinds
/// read them. Source: the paper, section V; dam/lipsync.md, sections 1 to 7.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dam/corpus/glitches.h"
#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// Settings of the methods dam-paper and cohen-massaro (which is of degree 0 and has one mode).
struct AnimemeOptions {
  int order = 4;  ///< M, degree of the polynomials: 0..kMaxOrder

  /// Eq. 2 is called a "summation of normalised values" but written as a plain sum. True: the blend
  /// is divided by the sum of the dominances, so every pose lies between those of the phones around
  /// it. False: the plain sum, which fits almost as well but may overshoot in unseen sequences.
  bool normalised = true;
  bool modes = true;        ///< several modes per phone (section V-A); false: one
  int resample_points = 7;  ///< samples of the spline over a phone: 2..32
  double preference = 2;    ///< of affinity propagation, times the smallest similarity: 0.1..100
  double damping = 0.9;     ///< of affinity propagation: 0.5..0.99
  int affinity_iterations = 300;  ///< at most: 1..10000
  int affinity_limit = 500;  ///< occurrences of a phone that are clustered; the others join the
                             ///< nearest exemplar: 2..5000
  int mode_examples = 12;    ///< a phone with fewer occurrences has one mode: 1..1000000
  int reassign_rounds = 5;   ///< rounds of moving occurrences to the best mode: 0..100
  /// Weight of -log P(mode | context) in that choice, per control: 0..1e6.
  double context_weight = 10;

  double ridge = 10;         ///< on polynomial coefficients, in frames: 0..1e6
  double width_prior = 10;   ///< on log(sigma), per control, in frames: 0..1e6
  double time_margin = 0.5;  ///< clamp of local time; infinity: free, as in the paper: 0..inf
};

/// One bit for each RefinedTerm.
inline constexpr std::uint32_t kAllTerms = 0xfffff;

/// Settings of the method dam.
struct RefinedOptions {
  /// Factor of all ridges: 0 chooses among 0.5, 1 and 2 on held-out sentences, else 0.001..1000.
  double ridge = 0;
  /// Weight of frames of rare words: 1 / (frames of the word) ^ this, 0..1; 0: all have the same
  /// weight. Training in parts does not know the words of the other parts and uses 0.
  double rare_words = 0.5;
  double width_prior = 50;         ///< on log widths and log strength, per control, frames: 0..1e6
  double offset_frames = 10;       ///< prior weight of a sentence's own offset: 0.01..1e9
  double time_margin = 0.3;        ///< clamp of local time: 0..100
  double duration_exponent = 0.3;  ///< strength of long phones: 0..2
  /// Terms that are learned: bit 1 << RefinedTerm. With fewer terms the model is simpler, for
  /// comparisons; RefinedTerm::phone is required.
  std::uint32_t terms = kAllTerms;
};

/// Settings of the method mmm.
struct TrajectoryOptions {
  int states = 3;             ///< Gaussians per phone, one for each equal part of its time: 1..8
  int order = 2;              ///< of the penalised derivative: 1..4
  double mean_prior = 2;      ///< on the means around those of the recording, in frames: 0..1e6
  double variance_prior = 1;  ///< on the logarithms of variances and smoothness: 0..1e6
  double tolerance = 1e-3;    ///< in place of TrainOptions::tolerance: 0..1
};

/// Settings of the methods viseme and triphone.
struct TableOptions {
  /// viseme: prior of the poses around the mean of each phone, in frames: 0..1e9. Large: the means.
  double pose_prior = 10;
  int points = 13;     ///< triphone: samples of a curve: 2..64
  double reach = 0.5;  ///< triphone: of a curve beyond its phone, in local time: 0.01..0.5
  int minimum = 1;     ///< triphone: required occurrences of a context: 1..1e6
  double trust = 10;   ///< triphone: weight of the coarser context, in occurrences: 0..1e6
};

/// All settings of training. The defaults are those of the built-in model; dam/measured.md
/// describes how they were chosen.
struct TrainOptions {
  Method method = Method::dam;   ///< kind of model
  RefinedOptions refined;        ///< for dam
  AnimemeOptions animeme;        ///< for dam-paper and cohen-massaro
  TrajectoryOptions trajectory;  ///< for mmm
  TableOptions table;            ///< for viseme and triphone

  int max_iterations = 30;  ///< accepted steps: 0..1000
  double tolerance = 2e-4;  ///< stop when the objective falls by less than this share: 0..1

  double pause_edge = 0.3;  ///< seconds of a long pause that belong to each side: 0.05..5
  int threads = 0;          ///< 0: number of cores; the result does not depend on it
  std::string attribution;  ///< copied into the model
  std::string provenance;   ///< copied into the model
};

/// Code::invalid_argument with the name and the range of the first bad option.
Result<void> validate(const TrainOptions& options);

/// A phone with so few examples that its shape is uncertain.
struct RarePhone {
  std::string label;         ///< the phone
  std::size_t examples = 0;  ///< occurrences in the data
  /// Method dam: the other learned phones of its class, whose common curve it shares; empty: it is
  /// shrunk towards the mean.
  std::vector<std::string> leans_on;
};

/// A phone that is not in the data, and what replaces it in synthesis ("AO IH": both in sequence);
/// empty: nothing, so scripts with it are refused.
struct UnknownPhone {
  std::string label;      ///< the phone
  std::string spoken_as;  ///< labels separated by spaces; empty: refused
};

/// Explained variance of a control.
struct ControlNote {
  std::string name;       ///< the control
  bool constant = false;  ///< it does not move in the data
  /// Share of the variance within sentences that the curves explain, at most 1; below 0: worse than
  /// the mean. 0 for a constant control.
  double explained = 0;
};

/// An outlier sentence, because of its offset or of its error.
struct SentenceNote {
  std::string id;     ///< the sentence
  double offset = 0;  ///< its constant error, in usual offsets of sentences
  double error = 0;   ///< the rest of its error, divided by the median over sentences
};

/// Estimated delay of the motion relative to its script.
struct LagEstimate {
  double seconds = 0;  ///< below 0: the motion is early
  double low = 0;      ///< lower end of the 95 % interval, by bootstrap over sentences
  double high = 0;     ///< upper end

  /// 40 ms or more, and surely above 20 ms: worth a shift.
  bool notable() const;
};

/// A sentence whose motion does not follow its script as in the other sentences.
struct ScriptDoubt {
  std::string id;    ///< the sentence
  double fit = 0;    ///< correlation of its motion with the motion expected from its script
  double usual = 0;  ///< median over all sentences of their best correlation
  /// Seconds by which its motion is later than in the others; nullopt: the text differs.
  std::optional<double> shift;
};

/// Whether scripts and motion match; see check_alignment().
struct Alignment {
  std::size_t sentences = 0;        ///< sentences examined
  std::optional<LagEstimate> lag;   ///< nullopt: too little data
  double fit = 0;                   ///< share of the motion explained by a known speaker's mouth
  double chance = 0;                ///< the same with scripts of other sentences: mean
  double chance_sd = 0;             ///< and standard deviation; 0: too few sentences
  bool unrelated = false;           ///< scripts of other sentences fit equally well
  std::vector<ScriptDoubt> doubts;  ///< the worst first; empty if `unrelated`
};

/// Results of training.
struct TrainSummary {
  std::vector<double> objective;   ///< start (dam-paper: after the modes are fixed), then after
                                   ///< every accepted step; never rises. mean: empty
  int iterations = 0;              ///< accepted steps
  std::vector<std::size_t> moved;  ///< dam-paper: occurrences that changed their mode, per round
  bool converged = false;          ///< false: stopped by max_iterations
  double seconds = 0;              ///< wall clock of the fit
  std::size_t utterances = 0;      ///< sentences used
  std::size_t frames = 0;          ///< frames fitted
  double speech_seconds = 0;       ///< those within 0.2 s of speech
  std::size_t occurrences = 0;     ///< phones fitted
  std::size_t modes = 0;           ///< of all phones; 0: the method has none
  double ridge = 0;                ///< dam: the factor of the ridges
  /// One for each control of the model. `explained` is that of held-out sentences: one of eight if
  /// the method is dam and there are 16 or more, else four folds in turn (with 16 sentences or more
  /// only the first), by models trained without them. One sentence, or train_from_sums() with fewer
  /// than 16: of the training sentences, which is optimistic.
  std::vector<ControlNote> controls;
  bool held_out = false;               ///< `explained` is that of held-out sentences
  std::vector<RarePhone> rare;         ///< under 12 examples
  std::vector<UnknownPhone> unknown;   ///< of the 41 of phones.h
  std::vector<SentenceNote> outliers;  ///< the three strongest outliers; see kOutlierOffset
  Alignment alignment;                 ///< of scripts and motion
  std::vector<Glitch> glitches;        ///< removed by remove_glitches()
  std::vector<std::string> warnings;   ///< sentences about everything above that needs attention
};

/// A sentence is in TrainSummary::outliers if its offset is above three usual ones or its error
/// above twice the median: often it has the labels of another one, or a tracking error. The usual
/// offset is 1.48 times the median over sentences, per control and at least a tenth of its
/// deviation; for a sentence the root mean square over controls counts. With fewer than 8 sentences
/// there is no usual offset.
inline constexpr double kOutlierOffset = 3,  ///< threshold of the offset, in usual offsets
    kOutlierError = 2;                       ///< threshold of the rest of its error, in medians
/// A control with a smaller explained share is reported as noise.
inline constexpr double kNoise = 0.02;

/// Progress of training.
struct Progress {
  const char* stage = "";  ///< "modes", "fit"
  double done = 0;         ///< 0..1 of the stage, an estimate
  double objective = 0;    ///< latest value, 0: none yet
};
/// Returns false to stop; train() then fails with Code::invalid_argument "cancelled".
using ProgressFunction = std::function<bool(const Progress&)>;

}  // namespace animeme::dam
