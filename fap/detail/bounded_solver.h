// Least squares with bounds by an active set. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::fap::internal {

/// Minimises w'Hw/2 - b'w over 0 <= w <= high. From frame to frame hardly any weight reaches or
/// leaves a bound, so a solver that begins with the weights of the frame before is done after a few
/// rounds; and it is exact, where coordinate descent takes thousands of sweeps if shapes are alike.
/// The same input gives the same weights everywhere.
class BoundedSolver {
 public:
  /// `matrix`: n x n, symmetric, positive definite in rows whose diagonal is not 0; weights of
  /// other rows stay as they are. `weights`: where to begin; the result.
  void solve(std::span<const double> matrix, std::span<const double> wanted,
             std::span<const double> highs, std::vector<double>& weights);

 private:
  enum class Bound : std::uint8_t { free, low, high, excluded };
  void settle_free(std::span<const double> matrix, std::span<const double> highs,
                   std::vector<double>& weights);
  void find_steps(std::span<const double> matrix, std::size_t n);

  std::vector<Bound> bounds_;      // of each weight
  std::vector<double> slopes_;     // what each weight could still explain
  std::vector<double> factors_;    // Cholesky's, of the part of the matrix for free weights
  std::vector<double> steps_;      // of free weights
  std::vector<std::size_t> free_;  // free weights
};

}  // namespace animeme::fap::internal
