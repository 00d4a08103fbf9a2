// Variable projection: what a step of some parameters looks like when everything linear follows.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace animeme::dam {

/// Takes (X^T J)^T (X^T X + P)^-1 (X^T J) off the Gauss-Newton matrix J^T J of the parameters,
/// control by control (Kaufman's form). `factor` is that of X^T X + P; `cross` holds X^T J,
/// (unknowns x parameters) by controls.
template <class Factor, class Cross>
void project_out(const Factor& factor, const Cross& cross, Eigen::MatrixXd& hessian) {
  const auto parameters = hessian.rows();
  const auto unknowns = factor.rows();
  for (Eigen::Index c = 0; c < cross.cols(); ++c) {
    Eigen::MatrixXd b(unknowns, parameters);
    for (Eigen::Index u = 0; u < unknowns; ++u)
      for (Eigen::Index g = 0; g < parameters; ++g) b(u, g) = cross(u * parameters + g, c);
    factor.matrixL().solveInPlace(b);
    hessian.noalias() -= b.transpose() * b;
  }
}

}  // namespace animeme::dam
