// Learning a model from recorded sentences. Source: the paper, section V; lipsync, section 5.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus.h"
#include "dam/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// Settings of the methods dam-paper and cohen-massaro (which is of degree 0 and has one mode).
struct AnimemeOptions {
  int order = 4;  ///< M, degree of the polynomials: 0..8

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

/// Settings of the method dam.
struct RefinedOptions {
  /// Factor of all ridges: 0 chooses among 0.5, 1 and 2 by sentences that are held out, else
  /// 0.001..1000.
  double ridge = 0;
  double width_prior = 50;         ///< on log widths and log strength, per control, frames: 0..1e6
  double offset_frames = 10;       ///< prior weight of a sentence's own offset: 0.01..1e9
  double time_margin = 0.3;        ///< clamp of local time: 0..100
  double duration_exponent = 0.3;  ///< strength of long phones: 0..2
};

/// All settings of training. The defaults are those of the shipped model; how they were chosen
/// stands in dam/README.md.
struct TrainOptions {
  Method method = Method::dam;
  RefinedOptions refined;  ///< for dam
  AnimemeOptions animeme;  ///< for dam-paper and cohen-massaro

  int max_iterations = 30;  ///< accepted steps: 0..1000
  double tolerance = 2e-4;  ///< stop when the objective falls by less than this part: 0..1

  double pause_edge = 0.3;  ///< seconds of a long pause that belong to each side: 0.05..5
  int threads = 0;          ///< 0: as the machine has; the result does not depend on it
  std::string attribution;  ///< copied into the model
  std::string provenance;   ///< copied into the model
};

/// Code::invalid_argument with the name and the range of the first bad option.
Result<void> validate(const TrainOptions& options);

/// What happened during training.
struct TrainSummary {
  std::vector<double> objective;  ///< once the modes are settled: start, then after every
                                  ///< accepted step; never rises
  int iterations = 0;             ///< accepted steps
  std::vector<std::size_t>
      moved;  ///< dam-paper: occurrences that changed their mode, per round before that
  bool converged = false;  ///< false: stopped by max_iterations
  double seconds = 0;      ///< wall clock
  std::size_t utterances = 0;
  std::size_t frames = 0;       ///< frames fitted
  std::size_t occurrences = 0;  ///< phones fitted
  std::size_t modes = 0;        ///< of all phones; 0: the method has none
  double ridge = 0;             ///< dam: the factor of the ridges
  /// Per control of the model: which part of the motion (the variance, less what a sentence is off
  /// as a whole) the curves explain, at most 1; below 0: worse than the mean. Method dam with 16 or
  /// more sentences: of sentences that were held out; otherwise of the training sentences.
  std::vector<double> explained;
  double lag = 0;  ///< seconds by which the signal seems to come after the phonemes
  std::vector<std::string> warnings;  ///< constant controls, phones with few examples, time lag
};

struct Progress {
  const char* stage = "";  ///< "modes", "fit"
  double done = 0;         ///< 0..1 of the stage, a guess
  double objective = 0;    ///< last known, 0: none yet
};
/// Returns false to stop; train() then fails with Code::invalid_argument "cancelled".
using ProgressFunction = std::function<bool(const Progress&)>;

/// Trains on all given sentences. They must have the same controls and rate.
/// The result is the same bit by bit for any number of threads and any order of the sentences.
/// Memory: about 30 MB + 8 bytes * (modes * (order + 1))^2 * 8.
/// Errors: invalid_argument (options, no sentence, no speech, cancelled, NaN in a signal,
/// different controls).
Result<Model> train(std::span<const Utterance> utterances, const TrainOptions& options = {},
                    TrainSummary* summary = nullptr, const ProgressFunction& progress = {});

}  // namespace animeme::dam
