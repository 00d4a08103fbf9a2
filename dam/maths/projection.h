// Gauss-Newton steps, and variable projection: what a step of some parameters looks like when
// everything linear follows.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>

namespace animeme::dam {

/// The damped Gauss-Newton step for parameters that are logarithms, each by 0.7 at most; 0 where
/// there is none. `gradient` holds n numbers, `hessian` n x n.
inline Eigen::VectorXd damped_step(std::span<const double> gradient,
                                   std::span<const double> hessian, double damping) {
  constexpr double kMostLogStep = 0.7;
  const auto n = Eigen::Index(gradient.size());
  Eigen::MatrixXd h = Eigen::Map<const Eigen::MatrixXd>(hessian.data(), n, n);
  h.diagonal() += damping * h.diagonal().cwiseAbs() + Eigen::VectorXd::Constant(n, 1e-9);
  Eigen::VectorXd delta =
      Eigen::LDLT<Eigen::MatrixXd>(h).solve(Eigen::Map<const Eigen::VectorXd>(gradient.data(), n));
  for (double& d : delta) d = std::isfinite(d) ? std::clamp(d, -kMostLogStep, kMostLogStep) : 0.0;
  return delta;
}

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
