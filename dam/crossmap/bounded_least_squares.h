/// @file
/// Least squares with limits: min |A x - b|^2, low <= x <= high, for one A and many b.
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

/// What the unknowns may be. low <= high; low is finite.
struct LeastSquaresLimits {
  double low = 0;                                         ///< of all unknowns
  double high = std::numeric_limits<double>::infinity();  ///< of all unknowns
  /// One for each unknown, instead of `low` and `high`. Empty: they hold for all.
  std::vector<double> lows = {};
  std::vector<double> highs = {};  ///< likewise
  /// What it costs to use an unknown, as a share of what it does, 0..1: |A x - b|^2 + ridge *
  /// sum_j |a_j|^2 x_j^2. Above 0 it keeps columns that do nearly the same from working against
  /// each other. 0: plain least squares.
  double ridge = 0;
};

/// An active set method on the normal equations, A^T A made once: unknowns are free or at a limit,
/// and the free ones are solved for by a Cholesky factor. A fit begins with the limits that the one
/// before ended with, since frames of a recording are alike, and lets all unknowns that are wrong
/// change places at once, as long as that makes fewer of them wrong (L. F. Portugal, J. J. Judice
/// and L. N. Vicente, Mathematics of Computation 63, 1994). Where it does not, one at a time does,
/// which always ends at the minimum (C. L. Lawson and R. J. Hanson, Solving Least Squares Problems,
/// 1974, chapter 23; with both limits: P. B. Stark and R. L. Parker, Computational Statistics 10,
/// 1995).
///
/// The result is the minimum up to rounding: A x is off by about 1e-15 * |b| * the condition of the
/// free columns. Where columns depend on each other (more unknowns than rows, two equal columns),
/// A x is unique and x is not: a column that those which are free can make stays at its limit. A
/// column of zeros stays at `low`. Not for two threads at a time; copy it.
class BoundedLeastSquares {
 public:
  /// `matrix`: rows x unknowns, row by row, finite; read here only. Limits as their comments say,
  /// unchecked.
  BoundedLeastSquares(std::span<const double> matrix, std::size_t rows, std::size_t unknowns,
                      const LeastSquaresLimits& limits = {});

  /// The unknowns for b = `target`, `rows` values. Good until the next call.
  std::span<const double> fit(std::span<const double> target);

  /// A^T b, which is all that a fit wants of b. Sums of targets have the sums of their products, so
  /// targets that are mixtures of a few known ones never have to be made.
  std::vector<double> products(std::span<const double> target) const;
  /// As fit(), for A^T b. Good until the next call.
  std::span<const double> fit_products(std::span<const double> products);

  /// The next fit begins with all at `low` (and the same bits come out as after construction).
  void restart();
  std::size_t unknowns() const { return n_; }  ///< length of x
  std::size_t rows() const { return rows_; }   ///< length of b
  /// How many systems of free unknowns the last fit solved.
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
  std::size_t solved_ = 0;         // how many free ones have a solution
  std::vector<std::size_t> used_;  // not 0
  std::vector<std::size_t> free_;  // in the order of the factor
  std::vector<At> at_;
  bool depends_ = false;              // a column was left out of the factor
  std::vector<std::uint8_t> barred_;  // must not be set free
};

}  // namespace animeme::dam
