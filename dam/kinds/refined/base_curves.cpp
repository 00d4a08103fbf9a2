#include "dam/kinds/refined/base_curves.h"

#include "dam/maths/linear_algebra.h"

namespace animeme::dam {
namespace {

double curve_ridge(double ridge, std::size_t order) {
  return ridge * (order == 0 ? 0.05 : double(order));
}

/// The normal equations of the base curves.
struct BaseSums {
  std::vector<double> gram;   // unknowns x unknowns, column by column
  std::vector<double> right;  // unknowns x controls, row by row
  double energy = 0;

  BaseSums& operator+=(const BaseSums& o) {
    add_all(gram, o.gram);
    add_all(right, o.right);
    energy += o.energy;
    return *this;
  }
};

void add_base(const SentenceView& view, std::size_t unknowns, std::size_t controls,
              BaseSums& sums) {
  std::vector<double> column_sum(unknowns), target_sum(controls);
  for (const std::size_t i : view.used()) {
    const double* y = view.target(i);
    sums.energy += dot(y, y, controls);
    for (std::size_t c = 0; c < controls; ++c) target_sum[c] += y[c];
    for (const RefinedPart& a : view.parts(i)) {
      const std::size_t row = a.phone * kRefinedOrders;
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double x = a.weight * a.basis[m];
        double* out = &sums.right[(row + m) * controls];
        for (std::size_t c = 0; c < controls; ++c) out[c] += x * y[c];
        column_sum[row + m] += x;
      }
      for (const RefinedPart& b : view.parts(i)) {
        const std::size_t column = b.phone * kRefinedOrders;
        for (std::size_t n = 0; n < kRefinedOrders; ++n) {
          const double w = a.weight * b.weight * b.basis[n];
          double* out = &sums.gram[(column + n) * unknowns + row];
          for (std::size_t m = 0; m < kRefinedOrders; ++m) out[m] += w * a.basis[m];
        }
      }
    }
  }
  const double share = 1 / view.offset();
  for (std::size_t j = 0; j < unknowns; ++j) {
    double* out = &sums.gram[j * unknowns];
    for (std::size_t i = 0; i < unknowns; ++i) out[i] -= share * column_sum[i] * column_sum[j];
    double* right = &sums.right[j * controls];
    const double scale = share * column_sum[j];
    for (std::size_t c = 0; c < controls; ++c) right[c] -= scale * target_sum[c];
  }
  sums.energy -= share * dot(target_sum, target_sum);
}

}  // namespace

Base solve_base(const RefinedData& data, const DominanceOptions& options,
                std::span<const PhoneDominance> dominance) {
  const std::size_t n = unknowns_of(data);
  const BaseSums zero{std::vector<double>(n * n), std::vector<double>(n * data.controls), 0};
  BaseSums sums = sum_over(data, zero, [&](const FitSentence& sentence, BaseSums& part) {
    add_base(SentenceView(data, sentence, dominance), n, data.controls, part);
  });
  for (std::size_t i = 0; i < n; ++i)
    sums.gram[i * n + i] += std::max(1e-6, curve_ridge(options.ridge, i % kRefinedOrders));
  Base base;
  base.factor = std::move(sums.gram);
  cholesky(base.factor, n);
  base.curves = sums.right;
  cholesky_solve(base.factor, n, base.curves, data.controls);
  base.objective = sums.energy - dot(base.curves, sums.right);
  return base;
}

}  // namespace animeme::dam
