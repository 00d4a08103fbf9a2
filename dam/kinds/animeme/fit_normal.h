// Shared by the two steps of the fit. The one header with Eigen in it: not installed (.hpp), only
// for the sources of this folder.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>

#include "dam/kinds/animeme/fit.h"

namespace animeme::dam {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The normal equations of Eq. 5, ridge included: unknowns are modes x terms, one right side a
/// control.
struct Normal {
  Eigen::MatrixXd gram;  ///< lower triangle only
  RowMatrix right;
  double energy = 0;  ///< sum of squares of the target
  Eigen::LLT<Eigen::MatrixXd> factor;
};
Normal make_normal(const FitData& data, const FitWeights& weights, std::span<const double> sigma);

}  // namespace animeme::dam
