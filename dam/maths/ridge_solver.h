// Large normal equations with a ridge, solved for several ridges and right sides at the cost of one
// factor of single precision.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dam/maths/lower_triangle.h"

namespace animeme::dam {

/// Solves (A + diag(ridge)) X = B by conjugate gradients in double precision. They are
/// preconditioned with the Cholesky factor of A + diag(usual ridge) in single precision, so a few
/// steps suffice for ridges near the usual one. Results depend on the numbers alone, not on threads
/// or vector units.
class RidgeSolver {
 public:
  /// `a` must outlive the solver and stay as it is. `usual`: a ridge of every unknown, at least 0.
  RidgeSolver(const LowerTriangle& a, std::span<const double> usual, int threads);

  /// False if the matrix has no factor: it is not positive definite even with a higher ridge.
  bool ok() const { return ok_; }

  /// Improves `x` (n x columns, row by row; zeros are a start) until the error in the norm of the
  /// matrix is below `tolerance` times that of zeros. False if that was not reached.
  bool solve(std::span<const double> ridge, std::span<const double> right, std::size_t columns,
             double tolerance, std::span<double> x) const;

 private:
  bool factorise(std::span<const double> usual, double lift);
  bool factorise_corner(std::size_t k);
  void precondition(const std::vector<double>& r, std::size_t width, std::vector<double>& z) const;
  void precondition_part(float* x, std::size_t width, std::size_t first, std::size_t count) const;
  void multiply(std::span<const double> ridge, const std::vector<double>& x, std::size_t width,
                std::vector<double>& product) const;
  float* tile(std::size_t i, std::size_t j);
  const float* tile(std::size_t i, std::size_t j) const;

  const LowerTriangle& a_;
  int threads_;
  std::size_t tiles_;           // on each side
  std::vector<double> scale_;   // of rows and columns, so that the diagonal becomes 1
  std::vector<float> factor_;   // tiles of the lower triangle, each column by column
  std::vector<float> inverse_;  // of the factor's tiles on the diagonal, times -1
  bool ok_ = false;
};

}  // namespace animeme::dam
