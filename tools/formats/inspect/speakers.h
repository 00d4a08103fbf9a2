/// @file
/// How training does for strangers: own sentences alone, another speaker's model as it is, and that
/// model adapted, over speakers who do not exist (warped_speakers.h).
///
///     inspect::SpeakersOptions options;
///     options.base = &base;                          // a model of method dam
///     const auto report = inspect::compare_speakers(corpus.utterances, options);
///     std::fputs(inspect::speakers_text(*report).c_str(), stdout);
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/evaluation/evaluate.h"
#include "dam/model/model.h"
#include "fap/result.h"
#include "tools/formats/inspect/warped_speakers.h"

namespace animeme::inspect {

/// Options of compare_speakers().
struct SpeakersOptions {
  const dam::Model* base = nullptr;              ///< required; of method dam
  std::size_t speakers = 8;                      ///< number of warped copies: 1..64
  std::vector<std::size_t> sizes = {5, 10, 20};  ///< own sentences to train on, ascending
  std::size_t most_tests = 40;                   ///< own sentences to score, at most
  /// Above 0: the base of each speaker is a model of the next warped speaker, trained on so many
  /// sentences at most that are neither trained on nor scored otherwise. So no base has learned
  /// from the recorded speaker's own face. 0: `base`.
  std::size_t base_sentences = 0;
  dam::TrainOptions train;        ///< of the own models and of adapt()
  dam::EvaluateOptions evaluate;  ///< how sentences are spoken
  int draws = 1000;               ///< bootstrap draws over speakers
  /// Sentences of others to score the base on, each for itself; may be empty.
  std::span<const dam::Utterance> others;
  /// Receives the progress, 0..1; returns false to stop.
  std::function<bool(double)> progress;
};

/// Measures of one system on one speaker's held-out sentences.
struct SpeakerScore {
  double gap_correlation = 0;  ///< mean over sentences of the correlation of the lip gap
  double gap_error = 0;        ///< NRMSE of the lip gap, offsets kept
  double gap_fitted = 0;       ///< the same after a gain and an offset
  double nrmse = 0;            ///< mean over the lip FAPs, offsets kept
  double fitted_nrmse = 0;     ///< the same after a gain and an offset for each
  double gap_recorded = 0;     ///< median gap of the speech, FAP units
  double gap_made = 0;         ///< the same of the synthesised motion

  static constexpr std::size_t kCount = 7;         ///< the numbers above
  std::array<double, kCount> values() const;       ///< in that order
  static std::array<const char*, kCount> names();  ///< their names in JSON
};

/// A mean over speakers and the interval that holds 95 % of bootstrap draws.
struct MeanInterval {
  double mean = 0;  ///< over the speakers
  double low = 0;   ///< lower end of the interval
  double high = 0;  ///< upper end
};

/// One system trained on so many own sentences.
struct SpeakersRow {
  std::string system;                                   ///< "own", "base", "adapted", "still"
  std::size_t sentences = 0;                            ///< of the speaker that it was trained on
  std::vector<SpeakerScore> scores;                     ///< one for each speaker
  std::array<MeanInterval, SpeakerScore::kCount> mean;  ///< of each measure
  /// "adapted": its measure minus that of "own", speaker by speaker.
  std::array<MeanInterval, SpeakerScore::kCount> over_own;
  /// "adapted": its measure minus that of "base", speaker by speaker.
  std::array<MeanInterval, SpeakerScore::kCount> over_base;
};

/// Result of compare_speakers().
struct SpeakersReport {
  std::vector<SpeakerHabits> speakers;     ///< whom the scores belong to
  std::size_t tests = 0;                   ///< sentences scored for each speaker
  std::vector<SpeakersRow> rows;           ///< by size, then still, base, own, adapted
  std::vector<std::string> others;         ///< ids of SpeakersOptions::others
  std::vector<SpeakerScore> other_scores;  ///< of the base, for each of them
  std::array<MeanInterval, SpeakerScore::kCount> other_mean;  ///< over them
};

/// Warps the sentences, trains and scores. Of each speaker's sentences, in an order that depends on
/// speaker and id, the first train and those behind the largest size are scored. Sizes that leave
/// fewer than four are left out. A sentence that a model cannot say, since it lacks a sound, counts
/// as a still face. Deterministic. Errors: invalid_argument (no base, too few sentences, stopped),
/// those of warp(), dam::train(), dam::adapt() and dam::score().
Result<SpeakersReport> compare_speakers(std::span<const dam::Utterance> sentences,
                                        const SpeakersOptions& options);

/// The report as a table.
std::string speakers_text(const SpeakersReport& report);
/// The report as JSON text, with every speaker's scores and habits.
std::string speakers_json(const SpeakersReport& report);

}  // namespace animeme::inspect
