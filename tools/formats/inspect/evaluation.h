/// @file
/// Evaluation of a system: its tracks compared with recordings, the error added by coding, and the
/// report.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "codec/encode/encode.h"
#include "dam/corpus/corpus.h"
#include "dam/corpus/glitches.h"
#include "dam/evaluation/evaluate.h"
#include "dam/evaluation/evaluate_bootstrap.h"
#include "fap/result.h"

namespace animeme::inspect {

/// Pairs the sentences `recorded` with a system's tracks, which have the same ids. Tracks must have
/// the rate of the recording and its length within 0.5 s; they are cut, or extended by their last
/// frame. With `skip_missing`, sentences without a track are skipped. Errors: not_found (no track),
/// out_of_range (another length).
Result<std::vector<dam::SentencePair>> pair_up(std::vector<dam::Utterance> tracks,
                                               const std::vector<dam::Utterance>& recorded,
                                               bool skip_missing);

/// The reference for errors of tracks: the recordings, restricted to the controls that the tracks
/// have as well. `pairs` is not empty. Errors: not_found if there is no such control.
Result<std::vector<dam::Control>> scale_of(const std::vector<dam::SentencePair>& pairs);

/// Replaces the recordings by those without glitches, so that errors of the tracker do not count as
/// errors of the system. Returns the glitches. See dam::remove_glitches().
std::vector<dam::Glitch> leave_out_glitches(std::vector<dam::SentencePair>& pairs);

/// Effect of coding on the motion.
struct CodecScore {
  std::size_t bytes = 0;  ///< of all streams
  double kbps = 0;        ///< of all sentences, 1000 bits a second
  dam::Evaluation error;  ///< decoded, relative to the motion before coding
  dam::Evaluation total;  ///< decoded, relative to the recordings
};
/// Encodes and decodes every sentence as a separate stream; `progress`, if given, receives 0..1.
/// Errors: those of encode() and score(); not_found without FAPs.
Result<CodecScore> score_codec(const std::vector<dam::SentencePair>& pairs,
                               const fba::EncodeOptions& coding, const dam::ScoreOptions& scoring,
                               const std::function<void(double)>& progress = {});

/// What one rule of synthesis changes in the errors: with the rule at 1 minus without it, without
/// any other rule.
struct RuleCost {
  std::string rule;            ///< "closure", "sharpness", "articulation"
  double nrmse = 0;            ///< Evaluation::nrmse
  double fitted_nrmse = 0;     ///< Evaluation::fitted_nrmse, for speakers of another size
  double gap_correlation = 0;  ///< Evaluation::gap_correlation
  double gap = 0;              ///< NRMSE of the inner gap; 0 if it is not there
  double jaw = 0;              ///< NRMSE of FAP 3; 0 if it is not there
};
/// Speaks the recordings without rules and with each of them. Errors: those of dam::evaluate().
Result<std::vector<RuleCost>> rule_costs(const dam::Model& model,
                                         std::span<const dam::Utterance> recorded,
                                         const dam::ScoreOptions& scoring);

/// The complete report.
struct EvaluationReport {
  std::string system;          ///< its name
  dam::Evaluation evaluation;  ///< of the system
  double closed_gap = 45;      ///< FAP units: a smaller inner lip gap counts as closed
  std::string against;         ///< name of the other system; empty: none
  std::optional<dam::PairedDifference> difference;  ///< system minus the other one
  std::size_t compared_controls = 0;                ///< scored controls of both systems
  std::optional<CodecScore> codec;                  ///< nullopt: not requested
  std::vector<RuleCost> rules;                      ///< empty: not requested
  dam::LeftOut left_out;                            ///< of the recordings
  std::vector<dam::Glitch> glitches;                ///< of the recordings
};

/// The report as JSON text.
std::string evaluation_json(const EvaluationReport& report);
/// The report as text; `full` adds the tables by control, phoneme, viseme, class and sentence.
std::string evaluation_text(const EvaluationReport& report, bool full);

}  // namespace animeme::inspect
