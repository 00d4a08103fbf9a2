/// @file
/// Synthesis, from a phoneme script to a control signal: section VI of the paper.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dam/model/model.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// All settings of synthesise().
struct SynthesisOptions {
  fap::Rate rate = {25, 1};  ///< of the output signal; at most 1000 frames per second
  std::size_t frames = 0;    ///< 0: as many as cover the script (and `tail`)
  double tail = 0;           ///< seconds added after the script: 0..60
  bool closure = true;       ///< P, B and M close the lips, F and V reach the teeth and lips never
                             ///< overlap (closure.h), if the FAPs are there
  /// Scale of the deviation from rest. 0 keeps the mouth at rest, 1 is as learned, 1.5 is
  /// exaggerated; P, B and M close at any value. 0..kMostStyle.
  double style = 1;
  /// Method dam: sharpening, which restores the speed of motion that a mean over many sentences
  /// loses. 0: the mean as learned, with the least error; 1: quicker by a tenth; 0..kMostSharpness.
  double sharpness = 1;
  /// Clearer vowels than learned, for models of FAPs: lips forward in O, U, W, SH and the like
  /// (dam/signal/rounding.h), the jaw lower in open vowels and higher in close ones and sibilants
  /// (dam/signal/mouth_opening.h). The gap between the lips and their corners stay as learned. 0:
  /// as learned; 1: by the rules; 0..kMostArticulation; nullopt: Model::articulation.
  std::optional<double> articulation = 0;
  /// The tongue by rule (dam/speaking/tongue.h): channels for FAP 44 to 47 behind those of the
  /// model, if that has jaw or lips as FAPs and no tongue.
  bool tongue = false;
  /// The resting mouth is the same on both sides: of each pair of controls (dam/signal/symmetry.h)
  /// the mean. Models have the smirk with which their speaker rests, which shows in every pause;
  /// the motion itself stays as learned.
  bool symmetric_rest = false;
  bool rest_at_ends = true;      ///< first and last frame are the resting mouth
  double context_weight = 1000;  ///< w_c of Eq. 10, >= 0
  double smoothness_weight = 1;  ///< w_s of Eq. 10, >= 0
};

inline constexpr double kMostStyle = 1.5;    ///< largest SynthesisOptions::style
inline constexpr double kMostSharpness = 3;  ///< largest SynthesisOptions::sharpness

/// The articulation with which a model speaks.
inline double articulation_of(const Model& model, const SynthesisOptions& options) {
  return options.articulation.value_or(model.articulation);
}

/// Code::invalid_argument with the name and the range of the first bad option.
Result<void> validate(const SynthesisOptions& options);

/// Replacements of unknown phones, and chosen modes.
struct SynthesisReport {
  /// "OY" -> "AO IY": every kind of replacement once, in order of appearance.
  std::vector<std::pair<std::string, std::string>> replaced;
  std::size_t replaced_phones = 0;     ///< number of replaced phones of the script
  std::size_t phones = 0;              ///< occurrences spoken, pauses included
  std::size_t closures = 0;            ///< P, B, M that had to be closed
  std::size_t lip_tooth_contacts = 0;  ///< F, V that had to be moved to the teeth
  std::vector<std::size_t> modes;  ///< dam-paper: chosen mode of every occurrence, pauses included
};

/// Makes the signal of all controls of the model for a script. The model must pass validate(), as
/// those of train() and read_model() do. Deterministic. The cost of a frame depends on the number
/// of phones near it, not on the length of the script.
///
/// Sounds longer than `PhoneModel::longest` (singing) hold their middle. In long pauses the mouth
/// rests `Model::pause_edge` seconds from the speech, and with rest_at_ends in the first and the
/// last frame. A script of silence gives the resting mouth. Unknown phones are replaced by their
/// relatives (dam/script/phones.h). Errors: invalid_argument (options, a script that check_script()
/// refuses), out_of_range (more than 10 million frames), not_found (a phone that has no relative in
/// the model; the message names it and its time).
Result<Signal> synthesise(const Model& model, const Script& script,
                          const SynthesisOptions& options = {}, SynthesisReport* report = nullptr);

/// The script with all unknown phones replaced, as in synthesise().
Result<Script> replace_unknown_phones(const Model& model, const Script& script,
                                      SynthesisReport* report = nullptr);

}  // namespace animeme::dam
