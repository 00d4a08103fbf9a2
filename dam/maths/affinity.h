// Affinity propagation: clustering by passing messages between data points (Frey and Dueck,
// Science 315, 2007), which the paper uses to find the modes of a phone.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace animeme::dam {

struct AffinityOptions {
  double damping = 0.9;      ///< share of the old message, 0.5..1 (exclusive)
  int max_iterations = 300;  ///< >= 1
  int stable = 50;           ///< stop when the exemplars stay the same for so many iterations
                             ///< and every point has accepted one
};

struct Clusters {
  std::vector<std::size_t> exemplars;  ///< indices of points, ascending, at least one
  std::vector<std::size_t> label;      ///< per point: index into `exemplars`
  int iterations = 0;
  bool converged = false;
};

/// Clusters n points. `similarity` is n x n row by row, larger is more alike (as a rule minus the
/// squared distance); its diagonal is ignored, `preference` takes its place: the larger, the
/// more clusters. Deterministic. n must be at least 1.
Clusters affinity_propagation(std::span<const double> similarity, double preference,
                              const AffinityOptions& options = {});

}  // namespace animeme::dam
