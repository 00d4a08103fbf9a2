/// @file
/// How good a system is: its tracks against recordings, the codec's share, and the report of it
/// all.
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

/// The sentences `recorded` with somebody's tracks of them, which have the same ids. Tracks must
/// have the rate of the recording and its length up to 0.5 s; they are cut, or hold their last
/// frame. A sentence without a track is left out with `skip_missing`. Errors: not_found (no track),
/// out_of_range (another length).
Result<std::vector<dam::SentencePair>> pair_up(std::vector<dam::Utterance> tracks,
                                               const std::vector<dam::Utterance>& recorded,
                                               bool skip_missing);

/// What errors of tracks are measured by: the recordings, for the controls that the tracks have,
/// too. `pairs` is not empty. Error: not_found if there is none.
Result<std::vector<dam::Control>> scale_of(const std::vector<dam::SentencePair>& pairs);

/// What coding does to the motion.
struct CodecScore {
  std::size_t bytes = 0;  ///< of all streams
  double kbps = 0;        ///< of all sentences, 1000 bits a second
  dam::Evaluation error;  ///< decoded against the motion before coding
  dam::Evaluation total;  ///< decoded against the recordings
};
/// Codes and decodes every sentence as a stream of its own; `progress`, if any, gets the share that
/// is done, 0..1. Errors: those of encode() and score(); not_found without FAPs.
Result<CodecScore> score_codec(const std::vector<dam::SentencePair>& pairs,
                               const fba::EncodeOptions& coding, const dam::ScoreOptions& scoring,
                               const std::function<void(double)>& progress = {});

/// Everything that was found out.
struct EvaluationReport {
  std::string system;                               ///< its name
  dam::Evaluation evaluation;                       ///< of the system
  double closed_gap = 45;                           ///< FAP units: a smaller inner gap is closed
  std::string against;                              ///< name of the other system; empty: none
  std::optional<dam::PairedDifference> difference;  ///< system less the other one
  std::size_t compared_controls = 0;                ///< scored ones that both systems have
  std::optional<CodecScore> codec;                  ///< nothing: not asked for
  dam::LeftOut left_out;                            ///< of the recordings
  std::vector<dam::Glitch> glitches;                ///< likewise
};

/// The report as JSON text.
std::string evaluation_json(const EvaluationReport& report);
/// The report for people; `full` adds the tables by control, phoneme, viseme, class and sentence.
std::string evaluation_text(const EvaluationReport& report, bool full);

}  // namespace animeme::inspect
