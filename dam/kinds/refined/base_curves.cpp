#include "dam/kinds/refined/base_curves.h"

namespace animeme::dam {
namespace {

double curve_ridge(double ridge, std::size_t order) {
  return ridge * (order == 0 ? 0.05 : double(order));
}

/// The normal equations of the base curves.
struct BaseSums {
  Eigen::MatrixXd gram;
  RowMatrix right;
  double energy = 0;

  BaseSums& operator+=(const BaseSums& o) {
    gram += o.gram;
    right += o.right;
    energy += o.energy;
    return *this;
  }
};

void add_base(const SentenceView& view, BaseSums& sums) {
  Eigen::VectorXd column_sum = Eigen::VectorXd::Zero(sums.gram.rows());
  Eigen::RowVectorXd target_sum = Eigen::RowVectorXd::Zero(sums.right.cols());
  for (const std::size_t i : view.used()) {
    const Row y = view.target(i);
    sums.energy += y.square().sum();
    target_sum += y.matrix();
    for (const RefinedPart& a : view.parts(i)) {
      const auto row = Eigen::Index(a.phone * kRefinedOrders);
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double x = a.weight * a.basis[m];
        sums.right.row(row + Eigen::Index(m)).array() += x * y;
        column_sum[row + Eigen::Index(m)] += x;
      }
      for (const RefinedPart& b : view.parts(i)) {
        const auto column = Eigen::Index(b.phone * kRefinedOrders);
        for (std::size_t n = 0; n < kRefinedOrders; ++n) {
          const double w = a.weight * b.weight * b.basis[n];
          double* out = &sums.gram(row, column + Eigen::Index(n));
          for (std::size_t m = 0; m < kRefinedOrders; ++m) out[m] += w * a.basis[m];
        }
      }
    }
  }
  const double share = 1 / view.offset();
  sums.gram.noalias() -= share * column_sum * column_sum.transpose();
  sums.right.noalias() -= share * column_sum * target_sum;
  sums.energy -= share * target_sum.squaredNorm();
}

}  // namespace

Base solve_base(const RefinedData& data, const DominanceOptions& options,
                std::span<const PhoneDominance> dominance) {
  const auto n = Eigen::Index(unknowns_of(data));
  const BaseSums zero{Eigen::MatrixXd::Zero(n, n), RowMatrix::Zero(n, Eigen::Index(data.controls)),
                      0};
  BaseSums sums = sum_over(data, zero, [&](const FitSentence& sentence, BaseSums& part) {
    add_base(SentenceView(data, sentence, dominance), part);
  });
  for (Eigen::Index i = 0; i < n; ++i)
    sums.gram(i, i) += std::max(1e-6, curve_ridge(options.ridge, std::size_t(i) % kRefinedOrders));
  Base base;
  base.factor.compute(sums.gram);
  base.curves = base.factor.solve(sums.right);
  base.objective = sums.energy - base.curves.cwiseProduct(sums.right).sum();
  return base;
}

}  // namespace animeme::dam
