/// @file
/// Training with little data: adapts the model of another speaker to a few sentences of a
/// character.
///
///     auto model = adapt(*builtin_model(), sentences, options, &report);
///
/// Half a minute of speech does not show all phones in all contexts; another speaker's model does,
/// but with other lips. So the output of the base model is mapped to the controls of the new
/// recordings, and the residual is learned like everything else, regularised by the ridges:
///
///     C_own(t) = offset + sum over controls b of the base: gain_b C_b(t)      least squares
///              + curves on the base's dominance              train_from_sums() of the residual
///
/// Both parts are sums of curves under the same dominance, so the result is one model of method
/// dam, as fast as any. It knows the phones of the base; others are replaced by their relatives, in
/// synthesis and in training.
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

/// Result of adapt().
struct AdaptReport {
  std::vector<AdaptedControl> controls;  ///< in the order of the recordings
  std::size_t sentences = 0;             ///< of the new speaker
  double seconds = 0;                    ///< of speech in them
  /// Factor of the ridges of the residual curves; 0: there are none, the base with gains was best.
  double ridge = 0;
  /// Error on held-out sentences of the new speaker, as a share of their variance, 0 with one
  /// sentence:
  double base_error = 0;              ///< of the base with gains alone
  double error = 0;                   ///< with the chosen curves
  double own_error = 0;               ///< of models trained on the new sentences alone
  Alignment alignment;                ///< of scripts and motion, by check_alignment()
  std::vector<Glitch> glitches;       ///< removed by remove_glitches()
  std::vector<std::string> warnings;  ///< sentences about both that need attention
};

/// `base` must be of method dam. Controls are those of the sentences. The ridge is chosen by
/// cross-validation, unless options.refined.ridge is set; other options that are used: attribution,
/// provenance, threads. The base's attribution is kept, in front of the new one. Deterministic.
/// Errors: invalid_argument (a base of another method, no sentence, different controls, NaN), and
/// those of synthesise() and train_from_sums().
Result<Model> adapt(const Model& base, std::span<const Utterance> sentences,
                    const TrainOptions& options = {}, AdaptReport* report = nullptr,
                    const ProgressFunction& progress = {});

}  // namespace animeme::dam
