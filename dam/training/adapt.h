/// @file
/// A model for a character of whom there is little: a model of somebody else, bent to the own
/// sentences.
///
///     auto model = adapt(*builtin_model(), sentences, options, &report);
///
/// Half a minute of a stranger does not tell how all phones of a language look beside each other;
/// another speaker's model does, but with other lips. So the base is told in the controls of the
/// own recordings, and what it leaves over is learned like everything else, held by the ridges:
///
///     C_own(t) = offset + sum over controls b of the base: gain_b C_b(t)      least squares
///              + curves on the base's dominance                             train_from_sums() of
///              the rest
///
/// Both parts are sums of curves under the same dominance, so the result is one model of method
/// dam, as fast as any. It knows the phones of the base; others are spoken, and trained, by their
/// relatives.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/train_options.h"
#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// How a control was made of the base.
struct AdaptedControl {
  std::string name;  ///< of the own recordings
  bool same_name =
      false;        ///< the base has it: one gain; else it is a mixture of all controls of the base
  double gain = 0;  ///< of the control of that name
  double base =
      0;  ///< share of the variance that the base explains, with gains and offsets, at most 1
};

/// What adapt() found.
struct AdaptReport {
  std::vector<AdaptedControl> controls;  ///< in the order of the recordings
  std::size_t sentences = 0;             ///< own ones
  double seconds = 0;                    ///< of speech in them
  /// Factor of the ridges on the curves of one's own; 0: there are none, the base with gains did
  /// best.
  double ridge = 0;
  /// Error on own sentences that were held out, as a share of their variance, 0 with one sentence:
  double base_error = 0;              ///< of the base with gains alone
  double error = 0;                   ///< with the curves that were chosen
  double own_error = 0;               ///< of models trained on the own sentences alone
  Alignment alignment;                ///< of scripts and motion, by check_alignment()
  std::vector<Glitch> glitches;       ///< what was taken out, by mend_glitches()
  std::vector<std::string> warnings;  ///< what of the two wants attention, in sentences
};

/// `base` must be of method dam. Controls are those of the sentences. The ridge is chosen by
/// sentences that are left out in turn, unless options.refined.ridge says it; other options that
/// count: attribution, provenance, threads. The base's attribution stays, in front of the own.
/// Deterministic. Errors: invalid_argument (a base of another method, no sentence, different
/// controls, NaN), and those of synthesise() and train_from_sums().
Result<Model> adapt(const Model& base, std::span<const Utterance> sentences,
                    const TrainOptions& options = {}, AdaptReport* report = nullptr,
                    const ProgressFunction& progress = {});

}  // namespace animeme::dam
