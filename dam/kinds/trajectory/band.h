// Symmetric positive banded systems: what a trajectory is the solution of. Cost and memory are
// linear in the number of points.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace animeme::dam {

inline constexpr std::size_t kMaxDifference = 4;

/// Factors (diag(precision) + weight * D^T D) of size precision.size(), where D takes the
/// differences of `order` (1..kMaxDifference) of neighbouring points; with no more points than
/// `order` there is no difference and the matrix is diagonal.
class BandFactor {
 public:
  /// All precisions must be above 0, so that there is always a solution.
  void factor(std::span<const double> precision, double weight, std::size_t order);
  /// Replaces the right side by the solution; as many points as were factored.
  void solve(std::span<double> x) const;

 private:
  std::size_t order_ = 0;
  std::vector<double> lower_;    ///< [i * order + m - 1]: element (i, i - m) of unit lower L
  std::vector<double> inverse_;  ///< 1 / pivot
};

/// D^T D x of the same D.
std::vector<double> roughness(std::span<const double> x, std::size_t order);

}  // namespace animeme::dam
