// All terms of all phones at once for a fixed dominance: one set of normal equations for all
// controls. What is summed here is all that training needs of a corpus, so sums of parts of a
// corpus can be added. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/kinds/refined/fit.h"
#include "dam/maths/square_matrix.h"

namespace animeme::dam {

/// Which unknowns there are: every neighbourhood that occurs, but of triphones only those of
/// kMostTriphones. A table without keys is a term that
/// is not learned.
struct TermSpace {
  struct Table {
    std::vector<std::uint32_t> keys;  ///< ascending
    std::size_t first = 0;            ///< number of the first unknown
  };
  std::array<Table, kTermCount> tables;
  std::size_t size = 0;  ///< unknowns

  /// Whether the term of an occurrence is one of the unknowns.
  bool holds(std::size_t term, const TermUse& use) const;
  /// Number of the first unknown of a key; it must be there.
  std::size_t at(std::size_t term, std::uint32_t key) const;
  /// Numbers the unknowns of all tables.
  void number();
};

TermSpace term_space(const RefinedData& data);

/// Sums over sentences. Of `gram`, n x n, the lower triangle counts; `right` is n x controls, row
/// by row.
struct CurveSums {
  SquareMatrix gram;
  std::vector<double> right;
  std::vector<double> energy;  ///< squared targets, per control
  std::size_t frames = 0;

  void add(const CurveSums& other);
};

/// Sums over the frames, each times its weight; 0 leaves it out.
CurveSums sum_curves(const RefinedData& data, const TermSpace& space,
                     std::span<const PhoneDominance> dominance, std::span<const float> weight);

/// Ridge of every unknown, times `factor`.
std::vector<double> ridge_of(const TermSpace& space, double factor);

/// Solves; unknowns x controls, row by row. Degenerate sums are held more firmly until they solve.
/// `work` is spoilt: empty, or what the last call for sums of this size left.
std::vector<double> solve_curves(const CurveSums& sums, const TermSpace& space,
                                 std::size_t controls, double ridge_factor, int threads,
                                 SquareMatrix& work);

/// Squared error of curves on the sentences that were summed, per control.
std::vector<double> errors_of(const CurveSums& sums, const std::vector<double>& curves,
                              std::size_t controls);

}  // namespace animeme::dam
