// Dense linear algebra on plain numbers: factors, products and eigenvectors. Its source is the only
// one that compiles Eigen, since every file that does so takes seconds more.
//
// A matrix is a span of its numbers, column by column unless a comment says row by row. Sizes are
// not checked. Results depend on the numbers alone, not on threads or addresses.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace animeme::dam {

// ---- sums ----

/// Sum of the products a[i] * b[i]; both have the same length. Even and odd places are summed
/// apart, four at a time, so that vector units can do it.
inline double dot(const double* a, const double* b, std::size_t count) {
  if (count < 2) return count == 0 ? 0 : a[0] * b[0];
  double even = a[0] * b[0], odd = a[1] * b[1];
  const std::size_t pairs = count / 2 * 2, fours = count / 4 * 4;
  if (pairs > 2) {
    double even2 = a[2] * b[2], odd2 = a[3] * b[3];
    for (std::size_t i = 4; i < fours; i += 4) {
      even += a[i] * b[i];
      odd += a[i + 1] * b[i + 1];
      even2 += a[i + 2] * b[i + 2];
      odd2 += a[i + 3] * b[i + 3];
    }
    even += even2;
    odd += odd2;
    if (pairs > fours) {
      even += a[fours] * b[fours];
      odd += a[fours + 1] * b[fours + 1];
    }
  }
  double sum = even + odd;
  if (count > pairs) sum += a[pairs] * b[pairs];
  return sum;
}
inline double dot(std::span<const double> a, std::span<const double> b) {
  return dot(a.data(), b.data(), a.size());
}

/// Sums of the columns of a matrix that lies row by row; at least one row.
std::vector<double> column_sums(std::span<const double> rows, std::size_t columns);

// ---- factors ----

/// Overwrites the lower triangle of an n x n matrix with its Cholesky factor L, A = L L^T. False if
/// the matrix is not positive definite; it is spoilt then.
bool cholesky(std::span<double> matrix, std::size_t n);

/// Overwrites `right` (n x columns, row by row) with the solution of L L^T x = right.
void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns);

/// As cholesky(), in tiles on up to `threads` threads (0: as the machine has), for large matrices.
/// The bits are those of cholesky() up to a size of one tile, 192.
bool cholesky_in_place(std::span<double> matrix, std::size_t n, int threads);

/// As cholesky_solve() above, on several threads.
void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns, int threads);

/// Overwrites `right` (n x columns) with the solution of L x = right.
void solve_lower(std::span<const double> factor, std::size_t n, std::span<double> right,
                 std::size_t columns);

/// The solution of A x = right for a symmetric matrix that need not be positive definite, by its
/// L D L^T factor with pivots. Not finite where the matrix is singular.
std::vector<double> solve_symmetric(std::span<const double> matrix, std::span<const double> right);

/// The same for several right sides: n x columns, row by row.
std::vector<double> solve_symmetric(std::span<const double> matrix, std::size_t n,
                                    std::span<const double> right, std::size_t columns);

struct Eigenvectors {
  std::vector<double> values;   ///< ascending
  std::vector<double> vectors;  ///< n x n, a column each, of length 1
};
/// Of a symmetric matrix, of which the lower triangle counts.
Eigenvectors symmetric_eigenvectors(std::span<const double> matrix, std::size_t n);

// ---- products ----

/// gram -= scale * B^T B; B: rows x n, gram: n x n.
void subtract_gram(std::span<const double> b, std::size_t rows, std::size_t n, double scale,
                   std::span<double> gram);

/// out -= scale * A x; A: out.size() x x.size(), row by row.
void subtract_product(std::span<const double> a, std::span<const double> x, double scale,
                      std::span<double> out);

}  // namespace animeme::dam
