// Cholesky factor of a large matrix in tiles, on several threads. The result does not depend on how
// many there are.
#pragma once

#include <cstddef>
#include <span>

namespace animeme::dam {

/// Overwrites the lower triangle of an n x n matrix (column by column) with its factor L, A = L
/// L^T. False if the matrix is not positive definite; it is spoilt then.
bool cholesky_in_place(std::span<double> matrix, std::size_t n, int threads);

/// Overwrites `right` (n x columns, row by row) with the solution of L L^T x = right.
void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns, int threads);

}  // namespace animeme::dam
