// The E-step: one Gram matrix and one factorisation for all controls.

#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/fit.h"
#include "dam/kinds/animeme/fit_normal.h"
#include "dam/maths/linear_algebra.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

/// Sentences are summed in this many parts, each in order: the sum must not depend on threads.
constexpr std::size_t kCoefficientParts = 8;

struct PartialSums {
  std::vector<double> gram;   // unknowns x unknowns, lower triangle, column by column
  std::vector<double> right;  // unknowns x controls, row by row
  double energy = 0;
};

void add(std::vector<double>& sums, const std::vector<double>& others) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += others[i];
}

void add_frame(const FitData& data, std::span<const Part> parts, const double* target,
               PartialSums& sums) {
  const std::size_t terms = data.terms(), k = data.controls;
  const std::size_t unknowns = sums.right.size() / k;
  sums.energy += dot(target, target, k);
  for (const Part& a : parts) {
    const std::size_t row = a.mode * terms;
    for (std::size_t m = 0; m < terms; ++m) {
      const double x = a.dominance * a.basis[m];
      double* out = &sums.right[(row + m) * k];
      for (std::size_t c = 0; c < k; ++c) out[c] += x * target[c];
    }
    for (const Part& b : parts) {
      if (b.mode > a.mode) continue;
      const double w = a.dominance * b.dominance;
      const std::size_t column = b.mode * terms;
      for (std::size_t n = 0; n < terms; ++n) {
        const double wn = w * b.basis[n];
        double* out = &sums.gram[(column + n) * unknowns + row];
        for (std::size_t m = 0; m < terms; ++m) out[m] += wn * a.basis[m];
      }
    }
  }
}

PartialSums sum_sentences(const FitData& data, std::span<const double> sigma, std::size_t from,
                          std::size_t to) {
  const std::size_t size = sigma.size() * data.terms();
  PartialSums sums{std::vector<double>(size * size), std::vector<double>(size * data.controls), 0};
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

// Level terms are hardly held, higher degrees more and more. The floor keeps modes that no frame
// supports solvable.
double ridge_of(std::size_t degree, double ridge) {
  return std::max(1e-8, ridge * (degree == 0 ? 0.05 : double(degree)));
}

}  // namespace

Normal make_normal(const FitData& data, const FitWeights& weights, std::span<const double> sigma) {
  const std::size_t count = data.sentences.size();
  std::vector<PartialSums> partial(std::min(kCoefficientParts, count));
  parallel_for(partial.size(), weights.threads, [&](std::size_t p) {
    partial[p] =
        sum_sentences(data, sigma, p * count / partial.size(), (p + 1) * count / partial.size());
  });
  std::vector<double> gram = std::move(partial[0].gram);
  Normal normal{std::move(partial[0].right), partial[0].energy, {}};
  for (std::size_t p = 1; p < partial.size(); ++p) {
    add(gram, partial[p].gram);
    add(normal.right, partial[p].right);
    normal.energy += partial[p].energy;
  }
  const std::size_t size = sigma.size() * data.terms();
  double most = 0;
  for (std::size_t i = 0; i < size; ++i) {
    gram[i * size + i] += ridge_of(i % data.terms(), weights.ridge);
    most = std::max(most, gram[i * size + i]);
  }
  // Degenerate data (duplicated phones, no ridge): hold everything more firmly until it solves.
  double lift = 1e-10 * (1 + most);
  for (int attempt = 0; attempt < 12; ++attempt, lift *= 10) {
    normal.factor = gram;
    if (cholesky(normal.factor, size)) break;
    for (std::size_t i = 0; i < size; ++i) gram[i * size + i] += lift;
  }
  return normal;
}

void solve_coefficients(const FitData& data, const FitWeights& weights, FitState& state) {
  const Normal normal = make_normal(data, weights, state.sigma);
  state.coefficients = normal.right;
  cholesky_solve(normal.factor, state.sigma.size() * data.terms(), state.coefficients,
                 data.controls);
  double prior = 0;
  for (const double sigma : state.sigma) prior += std::log(sigma) * std::log(sigma);
  state.objective = normal.energy - dot(state.coefficients, normal.right) +
                    weights.width_prior * double(data.controls) * prior;
}

}  // namespace animeme::dam
