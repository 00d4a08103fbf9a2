// All terms of all phones at once for a fixed dominance: one set of normal equations for all
// controls. What is summed here is all that training needs of a corpus, so sums of parts of a
// corpus can be added. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/kinds/refined/fit.h"
#include "dam/maths/lower_triangle.h"

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
  /// Place of a key in its table; it must be there.
  std::size_t row_of(std::size_t term, std::uint32_t key) const;
  /// Number of the first unknown of such a key.
  std::size_t at(std::size_t term, std::uint32_t key) const;
  /// Numbers the unknowns of all tables.
  void number();
};

TermSpace term_space(const RefinedData& data);

/// The columns of the normal equations. Keys that the same occurrences have, with the same scales,
/// would have equal columns: they are summed and solved as one, and the solution is shared out by
/// the ridges, which is the same solution. With little data half of the unknowns are of this kind.
struct TermColumns {
  std::vector<std::uint32_t> of;  ///< the column of each unknown
  std::size_t size = 0;           ///< how many there are
  /// Per key of each table: its first column, or none if another key stands for it.
  std::array<std::vector<std::uint32_t>, kTermCount> first;
  static constexpr std::uint32_t kNone = 0xffffffffu;
};

/// A column for each unknown.
TermColumns own_columns(const TermSpace& space);
/// One for all unknowns that are equal in these sentences.
TermColumns shared_columns(const RefinedData& data, const TermSpace& space);

/// Sums over sentences; `right` is columns x controls, row by row.
struct CurveSums {
  LowerTriangle gram;
  std::vector<double> right;
  std::vector<double> energy;  ///< squared targets, per control
  std::size_t frames = 0;

  CurveSums() = default;
  CurveSums(std::size_t columns, std::size_t controls)
      : gram(columns), right(columns * controls), energy(controls) {}
  void add(const CurveSums& other);
};

/// Adds the frames, each times its weight; 0 leaves it out. The same for any number of threads.
void add_curves(const RefinedData& data, const TermSpace& space, const TermColumns& columns,
                std::span<const PhoneDominance> dominance, std::span<const float> weight,
                CurveSums& sums);

/// The same from nothing, with own_columns().
CurveSums sum_curves(const RefinedData& data, const TermSpace& space,
                     std::span<const PhoneDominance> dominance, std::span<const float> weight);

/// Ridge of every column, times `factor`.
std::vector<double> ridge_of(const TermSpace& space, const TermColumns& columns, double factor);

/// Columns x controls, row by row. Degenerate sums are held more firmly until they solve.
std::vector<double> solve_curves(const LowerTriangle& gram, std::span<const double> right,
                                 const TermSpace& space, const TermColumns& columns,
                                 std::size_t controls, double ridge_factor, int threads);

/// Unknowns x controls, from a solution for columns.
std::vector<double> curves_of(const TermSpace& space, const TermColumns& columns,
                              const std::vector<double>& solution, std::size_t controls);

/// Squared errors and energies, per control.
struct CurveErrors {
  std::vector<double> error, energy;
};
/// Of a solution on the sentences that were summed.
CurveErrors errors_of(const CurveSums& sums, const std::vector<double>& solution,
                      std::size_t controls);
/// Of a solution on the frames that have a weight, without their sums.
CurveErrors errors_on(const RefinedData& data, const TermSpace& space, const TermColumns& columns,
                      std::span<const PhoneDominance> dominance, std::span<const float> weight,
                      const std::vector<double>& solution);

}  // namespace animeme::dam
