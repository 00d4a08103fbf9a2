/// @file
/// What training can be told, and what it tells: options, progress, summary. Below the kinds of
/// models, which all read them. Source: the paper, section V; dam/lipsync.md, sections 1 to 7.
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
  /// it. False: the plain sum, which fits almost as well but may overshoot in sequences never
  /// heard.
  bool normalised = true;
  bool modes = true;        ///< several modes a phone (section V-A); false: one
  int resample_points = 7;  ///< samples of the spline over a phone: 2..32
  double preference = 2;    ///< of affinity propagation, times the smallest similarity: 0.1..100
  double damping = 0.9;     ///< of affinity propagation: 0.5..0.99
  int affinity_iterations = 300;  ///< at most: 1..10000
  int affinity_limit = 500;  ///< occurrences of a phone that are clustered; the others join the
                             ///< nearest exemplar: 2..5000
  int mode_examples = 12;    ///< a phone with fewer occurrences has one mode: 1..1000000
  int reassign_rounds = 5;   ///< rounds of moving occurrences to the mode that fits: 0..100
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
  /// Factor of all ridges: 0 chooses among 0.5, 1 and 2 by sentences that are held out, else
  /// 0.001..1000.
  double ridge = 0;
  /// How much more a frame of a rare word counts: 1 / (frames of the word) ^ this, 0..1; 0: all
  /// alike. Training in parts, which does not know the words of the other parts, counts all alike.
  double rare_words = 0.5;
  double width_prior = 50;         ///< on log widths and log strength, per control, frames: 0..1e6
  double offset_frames = 10;       ///< prior weight of a sentence's own offset: 0.01..1e9
  double time_margin = 0.3;        ///< clamp of local time: 0..100
  double duration_exponent = 0.3;  ///< strength of long phones: 0..2
  /// Terms that are learned: bit 1 << RefinedTerm. Without all of them the model is simpler, as for
  /// comparisons; RefinedTerm::phone must be among them.
  std::uint32_t terms = kAllTerms;
};

/// Settings of the method mmm.
struct TrajectoryOptions {
  int states = 3;             ///< Gaussians a phone, one for each equal part of its time: 1..8
  int order = 2;              ///< of the derivative whose square is kept small: 1..4
  double mean_prior = 2;      ///< on the means around those of the recording, in frames: 0..1e6
  double variance_prior = 1;  ///< on the logarithms of variances and smoothness: 0..1e6
  double tolerance = 1e-3;    ///< in place of TrainOptions::tolerance: 0..1
};

/// Settings of the methods viseme and triphone.
struct TableOptions {
  /// viseme: on the poses around the mean of each phone, in frames: 0..1e9. Large: those means.
  double pose_prior = 10;
  int points = 13;     ///< triphone: samples of a curve: 2..64
  double reach = 0.5;  ///< triphone: of a curve beyond its phone, in local time: 0.01..0.5
  int minimum = 1;     ///< triphone: occurrences that a context needs: 1..1e6
  double trust = 10;   ///< triphone: in the coarser context, in occurrences: 0..1e6
};

/// All settings of training. The defaults are those of the shipped model; how they were chosen
/// stands in dam/README.md.
struct TrainOptions {
  Method method = Method::dam;   ///< which kind of model
  RefinedOptions refined;        ///< for dam
  AnimemeOptions animeme;        ///< for dam-paper and cohen-massaro
  TrajectoryOptions trajectory;  ///< for mmm
  TableOptions table;            ///< for viseme and triphone

  int max_iterations = 30;  ///< accepted steps: 0..1000
  double tolerance = 2e-4;  ///< stop when the objective falls by less than this part: 0..1

  double pause_edge = 0.3;  ///< seconds of a long pause that belong to each side: 0.05..5
  int threads = 0;          ///< 0: as the machine has; the result does not depend on it
  std::string attribution;  ///< copied into the model
  std::string provenance;   ///< copied into the model
};

/// Code::invalid_argument with the name and the range of the first bad option.
Result<void> validate(const TrainOptions& options);

/// A phone with so few examples that its shape is uncertain.
struct RarePhone {
  std::string label;         ///< the phone
  std::size_t examples = 0;  ///< occurrences in the data
  /// Method dam: the other learned phones of its class, whose common curve it leans on; nothing
  /// there: it leans on the mean.
  std::vector<std::string> leans_on;
};

/// A phone that was not in the data, and what synthesis will say instead ("AO IH": both, one after
/// the other); empty: nothing, so scripts with it will be refused.
struct UnknownPhone {
  std::string label;      ///< the phone
  std::string spoken_as;  ///< labels with blanks between; empty: refused
};

/// How much of a control the curves explain.
struct ControlNote {
  std::string name;       ///< the control
  bool constant = false;  ///< it does not move in the data
  /// Which part of the variance within sentences the curves explain, at most 1; below 0: worse than
  /// the mean. 0 for a constant control.
  double explained = 0;
};

/// How a sentence stands out; either may be why.
struct SentenceNote {
  std::string id;     ///< the sentence
  double offset = 0;  ///< what it is off as a whole, in usual offsets of sentences
  double error = 0;   ///< the rest of its error, divided by the median of the sentences
};

/// By how much the motion comes after its script, as far as the sentences tell.
struct LagEstimate {
  double seconds = 0;  ///< below 0: the motion comes before it
  double low = 0;      ///< least of the 95 % interval, by drawing sentences
  double high = 0;     ///< largest of it

  /// 40 ms or more, and surely above 20 ms: worth a shift.
  bool notable() const;
};

/// A sentence whose motion does not follow its script as that of the others does.
struct ScriptDoubt {
  std::string id;    ///< the sentence
  double fit = 0;    ///< correlation of its motion with what its script asks for
  double usual = 0;  ///< median over all sentences of the best that they reach
  /// Seconds by which its motion seems to come later than that of the others; none: another text.
  std::optional<double> shift;
};

/// Whether scripts and motion belong together; see check_alignment().
struct Alignment {
  std::size_t sentences = 0;        ///< that were looked at
  std::optional<LagEstimate> lag;   ///< none: too little to tell
  double fit = 0;                   ///< share of the motion that a known speaker's mouth explains
  double chance = 0;                ///< the same with scripts of other sentences: mean
  double chance_sd = 0;             ///< and deviation; 0: too few sentences to tell
  bool unrelated = false;           ///< scripts of other sentences would do as well
  std::vector<ScriptDoubt> doubts;  ///< the worst first; none if `unrelated`
};

/// What happened during training.
struct TrainSummary {
  std::vector<double> objective;  ///< start (dam-paper: once the modes are settled), then after
                                  ///< every accepted step; never rises. mean: empty
  int iterations = 0;             ///< accepted steps
  std::vector<std::size_t>
      moved;  ///< dam-paper: occurrences that changed their mode, per round before that
  bool converged = false;       ///< false: stopped by max_iterations
  double seconds = 0;           ///< wall clock of the fit
  std::size_t utterances = 0;   ///< sentences used
  std::size_t frames = 0;       ///< frames fitted
  double speech_seconds = 0;    ///< of these that lie within 0.2 s of speech
  std::size_t occurrences = 0;  ///< phones fitted
  std::size_t modes = 0;        ///< of all phones; 0: the method has none
  double ridge = 0;             ///< dam: the factor of the ridges
  /// One for each control of the model. `explained` is of sentences that were held out: one of
  /// eight if the method is dam and there are 16 or more, else four folds in turn (of 16 sentences
  /// or more the first alone), by models trained without them. One sentence, or train_from_sums()
  /// with fewer than 16: of the training sentences, which flatters.
  std::vector<ControlNote> controls;
  bool held_out = false;               ///< `explained` is of sentences that were held out
  std::vector<RarePhone> rare;         ///< under 12 examples
  std::vector<UnknownPhone> unknown;   ///< of the 41 of phones.h
  std::vector<SentenceNote> standing;  ///< the worst three, the worst first; see kStandsOut
  Alignment alignment;                 ///< of scripts and motion
  std::vector<Glitch> glitches;        ///< what was taken out, by mend_glitches()
  std::vector<std::string> warnings;   ///< all of the above that wants attention, in sentences
};

/// A sentence is named in TrainSummary::standing if its offset is above three usual ones or its
/// error above twice the median: often it has the labels of another one, or the tracker slipped.
/// The usual offset is 1.48 times the median over sentences, per control and at least a tenth of
/// its deviation; of a sentence the root mean square over controls counts. With fewer than 8
/// sentences nothing is usual.
inline constexpr double kStandsOut = 3,  ///< usual offsets from which on a sentence is named
    kErrorStandsOut = 2;                 ///< the same for the rest of its error
/// A control is said to move only by noise if less than this share is explained.
inline constexpr double kNoise = 0.02;

/// How far training is, for whoever waits.
struct Progress {
  const char* stage = "";  ///< "modes", "fit"
  double done = 0;         ///< 0..1 of the stage, a guess
  double objective = 0;    ///< last known, 0: none yet
};
/// Returns false to stop; train() then fails with Code::invalid_argument "cancelled".
using ProgressFunction = std::function<bool(const Progress&)>;

}  // namespace animeme::dam
