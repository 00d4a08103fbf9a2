/// @file
/// Confidence interval of the difference of two systems: paired bootstrap over sentences. Source:
/// dam/lipsync.md, section 8, item 7.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dam/evaluation/evaluate.h"
#include "fap/result.h"

namespace animeme::dam {

/// Options of paired_difference().
struct BootstrapOptions {
  int draws = 1000;        ///< 1..1000000
  std::uint64_t seed = 1;  ///< of a built-in generator: the same on every machine
  double coverage = 0.95;  ///< of the interval: 0.5..0.999
};

/// One error of two systems, over all sentences. Negative differences: a is better.
struct ErrorDifference {
  double a = 0,           ///< error of the first system
      b = 0;              ///< of the second
  double difference = 0;  ///< a - b
  double low = 0,         ///< lower end of the interval
      high = 0;           ///< upper end
  double below = 0;       ///< share of draws in which a has less error than b, 0..1
};

/// Two systems on the same sentences.
struct PairedDifference {
  std::size_t sentences = 0;  ///< with frames in both
  int draws = 0;              ///< as requested
  ErrorDifference nrmse,      ///< mean over scored controls
      l2;                     ///< norm over controls, see RegionScore
  ErrorDifference gap_rmse;   ///< FAP units; zeros without an inner gap
};

/// Draws as many sentences as there are, with replacement and the same for both, and computes both
/// errors over their frames, repeatedly. Both must be scores of the same recordings on the same
/// scale. Error: invalid_argument (options; sentences, frames or controls that differ).
Result<PairedDifference> paired_difference(const Evaluation& a, const Evaluation& b,
                                           const BootstrapOptions& options = {});

}  // namespace animeme::dam
