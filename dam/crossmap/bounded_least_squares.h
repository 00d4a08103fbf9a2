/// @file
/// Bounded least squares: min |A x - b|^2, low <= x <= high, for one A and many b.
///
///     BoundedLeastSquares shapes(matrix, rows, 52, {.high = 1});
///     for (const auto& frame : frames) use(shapes.fit(frame));
///
/// Both fits of the paper's Appendix A are of this kind: frames by key shapes (non-negative least
/// squares: low 0, no high), and vertices by controls (0 <= c <= 1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace animeme::dam {

/// Bounds of the unknowns. low <= high; low is finite.
struct LeastSquaresLimits {
  double low = 0;                                         ///< of all unknowns
  double high = std::numeric_limits<double>::infinity();  ///< of all unknowns
  /// One for each unknown, instead of `low` and `high`. Empty: the same for all.
  std::vector<double> lows = {};
  std::vector<double> highs = {};  ///< likewise
  /// Penalty on the use of an unknown, relative to its effect, 0..1: |A x - b|^2 + ridge * sum_j
  /// |a_j|^2 x_j^2. Above 0 it keeps similar columns from cancelling each other. 0: plain least
  /// squares.
  double ridge = 0;
};

/// An active set method on the normal equations, with A^T A computed once: unknowns are free or at
/// a bound, and the free ones are solved for by a Cholesky factor. A fit starts from the active set
/// of the previous fit, since frames of a recording are similar, and exchanges all unknowns that
/// violate the conditions at once, as long as that reduces their number (L. F. Portugal, J. J.
/// Judice and L. N. Vicente, Mathematics of Computation 63, 1994). Otherwise it exchanges one at a
/// time, which always ends at the minimum (C. L. Lawson and R. J. Hanson, Solving Least Squares
/// Problems, 1974, chapter 23; with both bounds: P. B. Stark and R. L. Parker, Computational
/// Statistics 10, 1995).
///
/// The result is the minimum up to rounding: A x is off by about 1e-15 * |b| * the condition of the
/// free columns. If columns are linearly dependent (more unknowns than rows, two equal columns), A
/// x is unique and x is not: a column that depends on the free ones stays at its bound. A column of
/// zeros stays at `low`. Not thread safe; copy it for each thread.
class BoundedLeastSquares {
 public:
  /// `matrix`: rows x unknowns, row by row, finite; only read here. Limits are not checked.
  BoundedLeastSquares(std::span<const double> matrix, std::size_t rows, std::size_t unknowns,
                      const LeastSquaresLimits& limits = {});

  /// The unknowns for b = `target`, `rows` values. Valid until the next call.
  std::span<const double> fit(std::span<const double> target);

  /// A^T b, all that a fit needs of b. Sums of targets have the sums of their products, so targets
  /// that are mixtures of a few known ones need not be computed.
  std::vector<double> products(std::span<const double> target) const;
  /// As fit(), for A^T b. Valid until the next call.
  std::span<const double> fit_products(std::span<const double> products);

  /// The next fit starts with all unknowns at `low`, exactly as after construction.
  void restart();
  std::size_t unknowns() const { return n_; }  ///< length of x
  std::size_t rows() const { return rows_; }   ///< length of b
  /// Number of linear systems solved by the last fit.
  std::size_t steps() const { return steps_; }

 private:
  enum class At : std::uint8_t { low, free, high };

  void factor_from(std::size_t first);
  void solve_free();
  void residual_products();
  double small_product() const;
  std::size_t find_wrong();
  void exchange();
  bool fit_by_blocks();
  void fit_by_steps();
  double step_to_limit(std::size_t& hit) const;
  void fix(std::size_t place, At limit);
  bool set_free();

  std::size_t rows_ = 0, n_ = 0, steps_ = 0;
  std::vector<double> matrix_;      // A, row by row
  std::vector<double> scale_;       // 1 / length of a column, 0 for none
  std::vector<double> gram_;        // of columns of length 1, with the ridge
  std::vector<double> low_, room_;  // room_: high - low, of scaled unknowns
  std::vector<double> low_products_;
  std::vector<double> want_;     // products of this fit, of scaled columns, measured from low
  std::vector<double> y_;        // scaled unknowns from low: 0..room
  std::vector<double> x_;        // the answer
  std::vector<double> left_;     // want - gram * y
  std::vector<double> factor_;   // lower, column by column, n_ apart
  std::vector<double> inverse_;  // 1 / diagonal of the factor
  std::vector<double> right_, solution_;
  std::size_t solved_ = 0;         // number of free ones with a solution
  std::vector<std::size_t> used_;  // not 0
  std::vector<std::size_t> free_;  // in the order of the factor
  std::vector<At> at_;
  bool depends_ = false;              // a dependent column was left out of the factor
  std::vector<std::uint8_t> barred_;  // must not be set free
};

}  // namespace animeme::dam
