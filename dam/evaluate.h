// How far synthesis is from recorded motion. Source: lipsync, section 8.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus.h"
#include "dam/model.h"
#include "dam/synthesise.h"
#include "fap/result.h"

namespace animeme::dam {

struct EvaluateOptions {
  SynthesisOptions synthesis;  ///< rate and frames are those of each recording
  double closed_gap = 45;      ///< FAP units: inner gap below which lips count as closed
};

/// Errors of one control over all scored frames, in its units (FAP units).
struct ControlScore {
  std::string name;
  bool scored = false;  ///< part of the means; FAP 14, 16, 17 ... are reported only
  double rmse = 0;
  double nrmse = 0;        ///< rmse / training standard deviation; 0 for a constant control
  double largest = 0;      ///< largest absolute error
  double correlation = 0;  ///< Pearson; 0 if one of the two does not move
};

/// A derived measure of the mouth, in FAP units.
struct MeasureScore {
  std::string name;  ///< "inner_gap", "width", "jaw"
  double rmse = 0;
  double correlation = 0;
};

struct UtteranceScore {
  std::string id;
  std::size_t frames = 0;  ///< scored
  double nrmse = 0;        ///< mean over scored controls
  double l2 = 0;
};

/// P, B and M: is there a frame from 40 ms before to 40 ms after the phone with the lips closed?
struct ClosureScore {
  std::size_t phones = 0;
  double measured = 0;  ///< share of them, 0..1
  double predicted = 0;
  std::size_t false_closures = 0;  ///< runs of frames in speech away from P, B, M (60 ms),
                                   ///< predicted closed and nowhere measured so
  double false_per_minute = 0;     ///< of scored time
};

/// Scored are measured frames within 0.2 s of speech, of the FAPs 3 to 13 and 51 to 60; of all
/// controls that move, if the model has none of these.
struct Evaluation {
  std::size_t utterances = 0;
  std::size_t frames = 0;
  double nrmse = 0;        ///< mean over scored controls
  double still_nrmse = 0;  ///< the same for a face that keeps the mean pose of the training speech
  double l2 = 0;  ///< mean over frames of the Euclidean norm of the error in standard deviations
  double correlation = 0;  ///< mean over scored controls
  std::vector<ControlScore> controls;
  std::vector<MeasureScore> measures;  ///< those whose FAPs are there
  ClosureScore closure;                ///< zeros without FAP 4 and 5
  std::vector<UtteranceScore> per_utterance;
};

/// Synthesises every sentence at the rate and length of its recording and compares.
/// Errors: those of synthesise() with the sentence named; invalid_argument if there is no sentence
/// or nothing to score; not_found if a recording lacks a control of the model.
Result<Evaluation> evaluate(const Model& model, std::span<const Utterance> utterances,
                            const EvaluateOptions& options = {});

/// True for FAP 3 to 13 and 51 to 60, by channel name.
bool is_scored_lip_fap(std::string_view name);

}  // namespace animeme::dam
