// Gauss-Newton steps, and variable projection: what a step of some parameters looks like when
// everything linear follows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace animeme::dam {

/// The damped Gauss-Newton step for parameters that are logarithms, each by 0.7 at most; 0 where
/// there is none. `gradient` holds n numbers, `hessian` n x n.
std::vector<double> damped_step(std::span<const double> gradient, std::span<const double> hessian,
                                double damping);

/// Takes (X^T J)^T (X^T X + P)^-1 (X^T J) off the Gauss-Newton matrix J^T J of the parameters
/// (`hessian`, parameters x parameters), control by control (Kaufman's form). `factor` is the
/// Cholesky factor of X^T X + P (unknowns x unknowns); `cross` holds X^T J, (unknowns x parameters)
/// by controls, row by row.
void project_out(std::span<const double> factor, std::size_t unknowns,
                 std::span<const double> cross, std::size_t controls, std::span<double> hessian,
                 std::size_t parameters);

}  // namespace animeme::dam
