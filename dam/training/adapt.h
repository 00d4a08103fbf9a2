/// @file
/// Training with little data: adapts the model of another speaker to a few sentences of a
/// character.
///
///     auto model = adapt(*builtin_model(), sentences, options, &report);
///
/// Half a minute of speech does not show all phones in all contexts; another speaker's model does,
/// but with other lips. So the model is a mixture of both:
///
///     C_own(t) = share * bent(t) + (1 - share) * curves learned from the sentences alone
///     bent(t)  = rest + levels of speech and of the silences next to it
///                + sum over controls b of the base: gain_b (C_b(t) - rest_b)
///                + curves of what that leaves over, or none
///
/// Cross-validation over the sentences chooses share and ridges by the squared error with offsets
/// kept. The rest is the person's own, with closed lips.
///
/// All parts are sums of curves under the base's dominance, so the result is one model of method
/// dam, as fast as any. It knows the phones of the base; others are replaced by their relatives, in
/// synthesis and in training. dam/training/README.md has the steps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// How a control was derived from the base.
struct AdaptedControl {
  std::string name;  ///< of the new recordings
  bool same_name =
      false;        ///< the base has it: one gain; else it is a mixture of all controls of the base
  double gain = 0;  ///< of the control of that name
  double base =
      0;  ///< share of the variance explained by the base with gains and offsets, at most 1
};

/// Errors on sentences that the model was not trained on; 0: not known.
struct HeldOutError {
  double nrmse = 0;        ///< RMS error / deviation in the speech, mean over controls that move;
                           ///< offsets count
  double correlation = 0;  ///< of the lip gap, -(FAP 4 + FAP 5), mean over sentences; without these
                           ///< FAPs: the mean over controls
};

/// Result of adapt().
struct AdaptReport {
  std::vector<AdaptedControl> controls;  ///< in the order of the recordings
  std::size_t sentences = 0;             ///< of the new speaker
  double seconds = 0;                    ///< of speech in them
  /// Share of the bent base in the result, mean over the controls: 0 own curves alone, 1 none.
  double base_share = 0;
  /// Factor of the ridges of the own curves on top of the bent base; 0: there are none.
  double ridge = 0;
  double own_ridge = 0;  ///< of the own curves beside it
  /// On held-out sentences of the new speaker, all 0 with one sentence:
  HeldOutError error;                 ///< of the chosen mixture
  HeldOutError base_error;            ///< of the base with gains and offsets alone
  HeldOutError own_error;             ///< of own curves alone
  HeldOutError still_error;           ///< of a face that keeps the mean pose
  Alignment alignment;                ///< of scripts and motion, by check_alignment()
  std::vector<Glitch> glitches;       ///< removed by remove_glitches()
  std::vector<std::string> warnings;  ///< sentences about both that need attention
};

/// `base` must be of method dam. Controls are those of the sentences. Ridges are chosen by
/// cross-validation, unless options.refined.ridge is set; other options that are used: attribution,
/// provenance, threads. The base's attribution is kept, in front of the new one. Deterministic.
/// Errors: invalid_argument (a base of another method, no sentence, different controls, NaN), and
/// those of synthesise() and train_from_sums().
Result<Model> adapt(const Model& base, std::span<const Utterance> sentences,
                    const TrainOptions& options = {}, AdaptReport* report = nullptr,
                    const ProgressFunction& progress = {});

}  // namespace animeme::dam
