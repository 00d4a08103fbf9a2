// The E-step: one Gram matrix and one factorisation for all controls.

#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/fit.h"
#include "dam/kinds/animeme/fit_normal.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

/// Sentences are summed in this many parts, each in order: the sum must not depend on threads.
constexpr std::size_t kCoefficientParts = 8;

struct PartialSums {
  Eigen::MatrixXd gram;  // lower triangle
  RowMatrix right;
  double energy = 0;
};

void add_frame(const FitData& data, std::span<const Part> parts, const double* target,
               PartialSums& sums) {
  const std::size_t terms = data.terms(), k = data.controls;
  const Eigen::Map<const Eigen::RowVectorXd> y(target, Eigen::Index(k));
  sums.energy += y.squaredNorm();
  for (const Part& a : parts) {
    const std::size_t row = a.mode * terms;
    for (std::size_t m = 0; m < terms; ++m)
      sums.right.row(Eigen::Index(row + m)) += a.dominance * a.basis[m] * y;
    for (const Part& b : parts) {
      if (b.mode > a.mode) continue;
      const double w = a.dominance * b.dominance;
      const std::size_t column = b.mode * terms;
      for (std::size_t n = 0; n < terms; ++n) {
        const double wn = w * b.basis[n];
        double* out = &sums.gram(Eigen::Index(row), Eigen::Index(column + n));
        for (std::size_t m = 0; m < terms; ++m) out[m] += wn * a.basis[m];
      }
    }
  }
}

PartialSums sum_sentences(const FitData& data, std::span<const double> sigma, std::size_t from,
                          std::size_t to) {
  const auto size = Eigen::Index(sigma.size() * data.terms());
  PartialSums sums{Eigen::MatrixXd::Zero(size, size),
                   RowMatrix::Zero(size, Eigen::Index(data.controls)), 0};
  for (std::size_t s = from; s < to; ++s) {
    const FitSentence& sentence = data.sentences[s];
    const Design design = make_design(data, sentence, sigma);
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      if (data.use[frame] == 0) continue;
      add_frame(data, design.frame(i), &data.target[frame * data.controls], sums);
    }
  }
  return sums;
}

}  // namespace

Eigen::VectorXd ridge_diagonal(const FitData& data, std::size_t modes, double ridge) {
  // Level terms are hardly held, higher degrees more and more. The floor keeps modes that no
  // frame supports solvable.
  Eigen::VectorXd diagonal(Eigen::Index(modes * data.terms()));
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    const auto degree = std::size_t(i) % data.terms();
    diagonal[i] = std::max(1e-8, ridge * (degree == 0 ? 0.05 : double(degree)));
  }
  return diagonal;
}

Normal make_normal(const FitData& data, const FitWeights& weights, std::span<const double> sigma) {
  const std::size_t count = data.sentences.size();
  std::vector<PartialSums> partial(std::min(kCoefficientParts, count));
  parallel_for(partial.size(), weights.threads, [&](std::size_t p) {
    partial[p] =
        sum_sentences(data, sigma, p * count / partial.size(), (p + 1) * count / partial.size());
  });
  Normal normal{std::move(partial[0].gram), std::move(partial[0].right), partial[0].energy, {}};
  for (std::size_t p = 1; p < partial.size(); ++p) {
    normal.gram += partial[p].gram;
    normal.right += partial[p].right;
    normal.energy += partial[p].energy;
  }
  normal.gram.diagonal() += ridge_diagonal(data, sigma.size(), weights.ridge);
  // Degenerate data (duplicated phones, no ridge): hold everything more firmly until it solves.
  double lift = 1e-10 * (1 + normal.gram.diagonal().maxCoeff());
  for (int attempt = 0; attempt < 12; ++attempt, lift *= 10) {
    normal.factor.compute(normal.gram);
    if (normal.factor.info() == Eigen::Success) break;
    normal.gram.diagonal().array() += lift;
  }
  return normal;
}

void solve_coefficients(const FitData& data, const FitWeights& weights, FitState& state) {
  const Normal normal = make_normal(data, weights, state.sigma);
  const RowMatrix a = normal.factor.solve(normal.right);
  state.coefficients.assign(a.data(), a.data() + a.size());
  double prior = 0;
  for (const double sigma : state.sigma) prior += std::log(sigma) * std::log(sigma);
  state.objective = normal.energy - a.cwiseProduct(normal.right).sum() +
                    weights.width_prior * double(data.controls) * prior;
}

}  // namespace animeme::dam
