// Shared by the two steps of the fit. Internal.
#pragma once

#include <span>
#include <vector>

#include "dam/kinds/animeme/fit.h"

namespace animeme::dam {

/// The normal equations of Eq. 5, ridge included: unknowns are modes x terms, one right side a
/// control.
struct Normal {
  std::vector<double> right;   ///< unknowns x controls, row by row
  double energy = 0;           ///< sum of squares of the target
  std::vector<double> factor;  ///< Cholesky factor, unknowns x unknowns, see linear_algebra.h
};
Normal make_normal(const FitData& data, const FitWeights& weights, std::span<const double> sigma);

}  // namespace animeme::dam
