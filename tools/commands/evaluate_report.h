/// @file
/// The parts of `animeme evaluate`: systems to compare, the codec's share, and what is printed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "dam/evaluation/evaluate_bootstrap.h"
#include "tools/commands/face_stream.h"
#include "tools/commands/model_input.h"

namespace animeme::tools {

/// A model, or somebody's tracks: ID.csv or ID.fap in a folder.
struct System {
  std::string path;                 ///< file or folder
  std::optional<dam::Model> model;  ///< none: tracks
};

/// A model file or "builtin"; a folder of tracks if it is one or `tracks` says so.
Result<System> open_system(const std::string& path, bool tracks);

/// The sentences with what the system makes of them. Tracks must have the rate of the recording and
/// its length up to 0.5 s; they are cut, or hold their last frame. Errors: those of reading and of
/// synthesis; not_found for a sentence without a track.
Result<std::vector<dam::SentencePair>> pairs_of(const System& system, const CorpusSettings& corpus,
                                                const std::vector<dam::Utterance>& recorded,
                                                const dam::EvaluateOptions& options);

/// What errors are measured by: the model's statistics, or those of the recordings for the controls
/// that the tracks have, too. Error: not_found if there is none.
Result<std::vector<dam::Control>> scale_of(const System& system,
                                           const std::vector<dam::SentencePair>& pairs);

/// What coding does to the motion.
struct CodecScore {
  std::size_t bytes = 0;  ///< of all streams
  double kbps = 0;        ///< kbit/s
  dam::Evaluation error;  ///< decoded against the motion before coding
  dam::Evaluation total;  ///< decoded against the recordings
};
/// Codes and decodes every sentence as a stream of its own. Errors: those of encode() and score();
/// not_found without FAPs.
Result<CodecScore> score_codec(const std::vector<dam::SentencePair>& pairs,
                               const StreamSettings& settings, const dam::ScoreOptions& scoring);

/// Everything that was found out.
struct EvaluateReport {
  std::string system;                               ///< its path
  dam::Evaluation evaluation;                       ///< against the recordings
  double closed_gap = 45;                           ///< see dam::ScoreOptions
  std::string against;                              ///< path of the other system; empty: none
  std::optional<dam::PairedDifference> difference;  ///< nothing: no other system
  std::size_t compared_controls = 0;                ///< scored ones that both systems have
  std::optional<CodecScore> codec;                  ///< nothing: not asked for
};

/// The report as JSON text.
std::string evaluate_json(const EvaluateReport& report);
/// Prints it; `full` adds the tables by control, phoneme, viseme, class and sentence.
void print_evaluation(const EvaluateReport& report, bool full);

/// Best, median and worst sentence by NRMSE: recorded and made curves of jaw, inner gap and width
/// (or of the first three controls). SVG, or PNG if `path` ends so. Errors: io, out_of_range
/// (sentences over ten minutes), unsupported (PNG without a renderer).
Result<void> write_picture(const std::string& path, const std::vector<dam::SentencePair>& pairs,
                           const dam::Evaluation& evaluation);

}  // namespace animeme::tools
