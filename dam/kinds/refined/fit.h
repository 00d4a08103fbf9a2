// The numbers of training the refined model. Internal. Source: dam/lipsync.md, sections 3 and 4,
// and dam/kinds/refined/README.md for sentence offsets.
//
// Targets are measured in standard deviations from the training mean. A sentence may be off by a
// constant that nothing predicts (posture, tracker): such offsets have the prior weight
// `offset_frames` and are eliminated, so every sum of products over a sentence loses the product of
// its sums divided by (frames + offset_frames).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dam/corpus/speech_data_internal.h"
#include "dam/corpus/train_options.h"
#include "dam/kinds/refined/terms.h"
#include "dam/model/model.h"

namespace animeme::dam {

/// What is fitted, with all that stays the same during the fit.
struct RefinedData {
  const SpeechData* speech = nullptr;
  std::span<const PhoneModel> phones;
  std::size_t controls = 0;           ///< of `target`: all, or the principal components
  std::size_t prior_controls = 0;     ///< all: what priors are multiplied by
  std::vector<double> target;         ///< frames x controls
  std::vector<Neighbourhood> around;  ///< per occurrence
  double time_margin = 0.3;
  double duration_exponent = 0.3;
  double offset_frames = 10;
  std::uint32_t terms = kAllTerms;  ///< see RefinedOptions
  int threads = 0;
};

/// One phone's part in one frame.
struct RefinedPart {
  std::uint32_t occurrence = 0;
  std::uint32_t phone = 0;
  double weight = 0;             ///< D / sum of D
  double before = 0, after = 0;  ///< squared distances in widths: (b / L)^2, (a / R)^2
  double basis[kRefinedOrders] = {};
};

/// parts[begin[i]] .. parts[begin[i + 1] - 1] belong to frame i of the sentence.
struct RefinedDesign {
  std::vector<std::size_t> begin;
  std::vector<RefinedPart> parts;
  std::span<const RefinedPart> frame(std::size_t i) const {
    return {parts.data() + begin[i], begin[i + 1] - begin[i]};
  }
};

RefinedDesign make_refined_design(const RefinedData& data, const FitSentence& sentence,
                                  std::span<const PhoneDominance> dominance);

/// Neighbourhoods of all occurrences.
std::vector<Neighbourhood> neighbourhoods(const SpeechData& speech,
                                          std::span<const PhoneModel> phones);

// ---- dominance ----

struct DominanceOptions {
  double ridge = 10;  ///< of the base curves while the dominance is sought
  double prior = 50;  ///< on log L, log R, log strength around 80 ms and 1, per control
  int max_steps = 15;
  double tolerance = 2e-4;
};

struct DominanceFit {
  std::vector<PhoneDominance> dominance;
  std::vector<double> base;  ///< phones x kRefinedOrders x controls, best for that dominance
  double objective = 0;      ///< squared error + ridge + prior
};

/// The start of a fit: 80 ms, strength 1, and the best base curves.
DominanceFit start_dominance(const RefinedData& data, const DominanceOptions& options,
                             std::span<const PhoneDominance> dominance = {});

/// Gauss-Newton with damping and variable projection; the objective never rises. `accepted` is
/// called after each step and returns false to stop. True if it converged.
bool fit_dominance(const RefinedData& data, const DominanceOptions& options, DominanceFit& fit,
                   const std::function<bool(const DominanceFit&)>& accepted);

/// Gradient (downhill) and Gauss-Newton matrix for log L, log R, log strength of all phones, in
/// this order; exposed for tests.
struct DominanceStep {
  std::vector<double> gradient, hessian;
};
DominanceStep dominance_step(const RefinedData& data, const DominanceOptions& options,
                             const DominanceFit& fit, bool project);

}  // namespace animeme::dam
