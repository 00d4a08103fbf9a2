#include "fap/detail/bounded_solver.h"

#include <algorithm>
#include <cmath>

namespace animeme::fap::internal {
namespace {

constexpr int kMostRounds = 500;
constexpr double kStill = 1e-7;  // a weight that would change less stays at its bound
constexpr double kFirm = 1e-9;   // share of its own effect that keeps equal shapes apart

}  // namespace

void BoundedSolver::solve(std::span<const double> matrix, std::span<const double> wanted,
                          std::span<const double> highs, std::vector<double>& weights) {
  const std::size_t n = weights.size();
  slopes_.assign(wanted.begin(), wanted.end());
  bounds_.resize(n);
  free_.reserve(n);  // once, so that no later frame allocates
  factors_.reserve(n * n);
  steps_.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    bounds_[i] = Bound::excluded;
    if (matrix[i * n + i] <= 0) continue;
    weights[i] = std::clamp(weights[i], 0.0, highs[i]);
    bounds_[i] = weights[i] <= 0 ? Bound::low : weights[i] >= highs[i] ? Bound::high : Bound::free;
    if (weights[i] == 0) continue;
    for (std::size_t j = 0; j < n; ++j) slopes_[j] -= matrix[i * n + j] * weights[i];
  }
  for (int round = 0; round < kMostRounds; ++round) {
    settle_free(matrix, highs, weights);
    // The weight that would go farthest if its bound let it.
    std::size_t next = n;
    double most = kStill;
    for (std::size_t i = 0; i < n; ++i) {
      const bool low = bounds_[i] == Bound::low;
      if ((!low && bounds_[i] != Bound::high) || highs[i] <= 0) continue;
      const double way = slopes_[i] / matrix[i * n + i];
      const double inwards = low ? way : -way;
      if (inwards <= most) continue;
      most = inwards;
      next = i;
    }
    if (next == n) return;
    bounds_[next] = Bound::free;
  }
}

// The steps of the free weights to where they are nearest.
void BoundedSolver::find_steps(std::span<const double> matrix, std::size_t n) {
  const std::size_t m = free_.size();
  factors_.resize(m * m);
  steps_.resize(m);
  for (std::size_t r = 0; r < m; ++r) {
    const double* row = factors_.data() + r * m;
    for (std::size_t c = 0; c <= r; ++c) {
      const double* other = factors_.data() + c * m;
      double sum = matrix[free_[r] * n + free_[c]];
      for (std::size_t k = 0; k < c; ++k) sum -= row[k] * other[k];
      const double own = matrix[free_[r] * n + free_[r]];
      factors_[r * m + c] = r == c ? std::sqrt(std::max(sum, kFirm * own)) : sum / other[c];
    }
  }
  for (std::size_t r = 0; r < m; ++r) {
    double sum = slopes_[free_[r]];
    for (std::size_t k = 0; k < r; ++k) sum -= factors_[r * m + k] * steps_[k];
    steps_[r] = sum / factors_[r * m + r];
  }
  for (std::size_t r = m; r-- > 0;) {
    double sum = steps_[r];
    for (std::size_t k = r + 1; k < m; ++k) sum -= factors_[k * m + r] * steps_[k];
    steps_[r] = sum / factors_[r * m + r];
  }
}

// Moves the free weights to where they are nearest; those that meet a bound on the way stay there.
void BoundedSolver::settle_free(std::span<const double> matrix, std::span<const double> highs,
                                std::vector<double>& weights) {
  const std::size_t n = weights.size();
  for (;;) {
    free_.clear();
    for (std::size_t i = 0; i < n; ++i) {
      if (bounds_[i] == Bound::free) free_.push_back(i);
    }
    if (free_.empty()) return;
    find_steps(matrix, n);
    double share = 1;
    std::size_t stop = n;
    for (std::size_t r = 0; r < free_.size(); ++r) {
      const std::size_t i = free_[r];
      const double room = steps_[r] < 0 ? -weights[i] : highs[i] - weights[i];
      if (std::abs(steps_[r]) <= std::abs(room)) continue;
      const double part = std::abs(room / steps_[r]);
      if (part >= share) continue;
      share = part;
      stop = i;
    }
    for (std::size_t r = 0; r < free_.size(); ++r) {
      const std::size_t i = free_[r];
      const double end = steps_[r] < 0 ? 0 : highs[i];
      const double change = i == stop ? end - weights[i] : share * steps_[r];
      weights[i] = i == stop ? end : weights[i] + change;
      if (change == 0) continue;
      for (std::size_t j = 0; j < n; ++j) slopes_[j] -= matrix[i * n + j] * change;
    }
    if (stop == n) return;
    bounds_[stop] = weights[stop] <= 0 ? Bound::low : Bound::high;
  }
}

}  // namespace animeme::fap::internal
