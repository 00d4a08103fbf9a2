// The curves that are best for sums.
#include <algorithm>
#include <cmath>

#include "dam/kinds/refined/curves_fit.h"
#include "dam/maths/linear_algebra.h"
#include "dam/maths/ridge_solver.h"

namespace animeme::dam {
namespace {

/// Of the solution: far below the single precision of a model's tables.
constexpr double kSolved = 1e-8;

/// Ridge of an unknown, without a factor.
double usual_ridge(std::size_t term, std::size_t order) { return kTermInfo[term].ridge[order]; }

/// 1 / ridge of every column: columns of equal unknowns are as loose as these together.
std::vector<double> looseness(const TermSpace& space, const TermColumns& columns) {
  std::vector<double> loose(columns.size, 0.0);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t i = 0; i < space.tables[t].keys.size() * kTermInfo[t].orders; ++i)
      loose[columns.of[space.tables[t].first + i]] += 1 / usual_ridge(t, i % kTermInfo[t].orders);
  return loose;
}

/// In double precision, with a lift that grows until there is a factor.
std::vector<double> solve_firmly(const LowerTriangle& gram, std::span<const double> right,
                                 std::span<const double> ridge, std::size_t controls, int threads) {
  const std::size_t n = gram.rows();
  std::vector<double> work(n * n);
  double lift = 1e-6;
  for (int attempt = 0; attempt < 12; ++attempt, lift *= 10) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto below = gram.below(i);
      std::copy(below.begin(), below.end(), work.begin() + std::ptrdiff_t(i * n + i));
      work[i * n + i] += ridge[i] + lift;
    }
    if (!cholesky_in_place(work, n, threads)) continue;
    std::vector<double> curves(right.begin(), right.end());
    cholesky_solve(work, n, curves, controls, threads);
    return curves;
  }
  return std::vector<double>(n * controls, 0.0);
}

}  // namespace

std::vector<double> ridge_of(const TermSpace& space, const TermColumns& columns, double factor) {
  std::vector<double> ridge = looseness(space, columns);
  for (double& r : ridge) r = factor / r;
  return ridge;
}

std::vector<double> solve_curves(const LowerTriangle& gram, std::span<const double> right,
                                 const TermSpace& space, const TermColumns& columns,
                                 std::size_t controls, double ridge_factor, int threads) {
  const std::vector<double> ridge = ridge_of(space, columns, ridge_factor);
  std::vector<double> solution(columns.size * controls, 0.0);
  const RidgeSolver solver(gram, ridge, threads);
  if (solver.solve(ridge, right, controls, kSolved, solution)) return solution;
  return solve_firmly(gram, right, ridge, controls, threads);
}

std::vector<double> curves_of(const TermSpace& space, const TermColumns& columns,
                              const std::vector<double>& solution, std::size_t controls) {
  const std::vector<double> loose = looseness(space, columns);
  std::vector<double> curves(space.size * controls);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t i = 0; i < space.tables[t].keys.size() * kTermInfo[t].orders; ++i) {
      const std::size_t unknown = space.tables[t].first + i, column = columns.of[unknown];
      const double share = 1 / usual_ridge(t, i % kTermInfo[t].orders) / loose[column];
      for (std::size_t c = 0; c < controls; ++c)
        curves[unknown * controls + c] = share * solution[column * controls + c];
    }
  return curves;
}

CurveErrors errors_of(const CurveSums& sums, const std::vector<double>& solution,
                      std::size_t controls) {
  const std::size_t n = sums.gram.rows(), k = controls;
  std::vector<double> product(n * k);
  for (std::size_t j = 0; j < n; ++j) {
    const auto below = sums.gram.below(j);
    for (std::size_t i = j; i < n; ++i) {
      const double g = below[i - j];
      if (g == 0) continue;
      for (std::size_t c = 0; c < k; ++c) product[i * k + c] += g * solution[j * k + c];
      if (i == j) continue;
      for (std::size_t c = 0; c < k; ++c) product[j * k + c] += g * solution[i * k + c];
    }
  }
  CurveErrors errors{sums.energy, sums.energy};
  for (std::size_t i = 0; i < n * k; ++i)
    errors.error[i % k] += solution[i] * (product[i] - 2 * sums.right[i]);
  return errors;
}

}  // namespace animeme::dam
