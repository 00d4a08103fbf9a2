#include "dam/kinds/trajectory/band.h"

#include <algorithm>
#include <array>

namespace animeme::dam {
namespace {

/// Signed binomials: the difference of `order` at points i .. i + order.
std::array<double, kMaxDifference + 1> difference(std::size_t order) {
  std::array<double, kMaxDifference + 1> d{1};
  for (std::size_t k = 1; k <= order; ++k)
    for (std::size_t m = k + 1; m-- > 0;) d[m] = (m > 0 ? d[m - 1] : 0.0) - d[m];
  return d;
}

/// Row i of L D L^T from the rows before it; `row` holds the elements (i, i) .. (i, i - K).
template <std::size_t K>
void eliminate(std::size_t i, std::array<double, kMaxDifference + 1>& row, double* lower,
               double* inverse) {
  // Products l(i, i - m) * pivot(i - m), from the farthest.
  std::array<double, K + 1> scaled{};
  double pivot = row[0];
  for (std::size_t m = std::min(i, K); m > 0; --m) {
    double value = row[m];
    for (std::size_t p = std::min(i, K); p > m; --p)
      value -= scaled[p] * lower[(i - m) * K + (p - m) - 1];
    scaled[m] = value;
    lower[i * K + m - 1] = value * inverse[i - m];
    pivot -= value * lower[i * K + m - 1];
  }
  // Rounding can eat a pivot only where the data weigh nothing beside the differences.
  inverse[i] = 1 / std::max(pivot, 1e-12 * row[0]);
}

template <std::size_t K>
void factor_band(std::span<const double> precision, double weight, double* lower, double* inverse) {
  const std::size_t n = precision.size();
  const auto d = difference(K);
  for (std::size_t i = 0; i < n; ++i) {
    std::array<double, kMaxDifference + 1> row{precision[i]};
    // Differences that touch i begin at i - K .. i and end within the points.
    for (std::size_t begin = i < K ? 0 : i - K; n > K && begin <= std::min(i, n - 1 - K); ++begin)
      for (std::size_t m = 0; m <= i - begin; ++m)
        row[m] += weight * d[i - begin] * d[i - begin - m];
    eliminate<K>(i, row, lower, inverse);
  }
}

template <std::size_t K>
void solve_band(std::span<double> x, const double* lower, const double* inverse) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    double value = x[i];
    for (std::size_t m = std::min(i, K); m > 0; --m) value -= lower[i * K + m - 1] * x[i - m];
    x[i] = value;
  }
  for (std::size_t i = n; i-- > 0;) {
    double value = x[i] * inverse[i];
    for (std::size_t m = std::min(n - 1 - i, K); m > 0; --m)
      value -= lower[(i + m) * K + m - 1] * x[i + m];
    x[i] = value;
  }
}

}  // namespace

void BandFactor::factor(std::span<const double> precision, double weight, std::size_t order) {
  order_ = order;
  lower_.assign(precision.size() * order, 0.0);
  inverse_.assign(precision.size(), 0.0);
  double* lower = lower_.data();
  double* inverse = inverse_.data();
  switch (order) {
    case 1:
      return factor_band<1>(precision, weight, lower, inverse);
    case 2:
      return factor_band<2>(precision, weight, lower, inverse);
    case 3:
      return factor_band<3>(precision, weight, lower, inverse);
    default:
      return factor_band<4>(precision, weight, lower, inverse);
  }
}

void BandFactor::solve(std::span<double> x) const {
  switch (order_) {
    case 1:
      return solve_band<1>(x, lower_.data(), inverse_.data());
    case 2:
      return solve_band<2>(x, lower_.data(), inverse_.data());
    case 3:
      return solve_band<3>(x, lower_.data(), inverse_.data());
    default:
      return solve_band<4>(x, lower_.data(), inverse_.data());
  }
}

std::vector<double> roughness(std::span<const double> x, std::size_t order) {
  const auto d = difference(order);
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t begin = 0; begin + order < x.size(); ++begin) {
    double sum = 0;
    for (std::size_t m = 0; m <= order; ++m) sum += d[m] * x[begin + m];
    for (std::size_t m = 0; m <= order; ++m) out[begin + m] += d[m] * sum;
  }
  return out;
}

}  // namespace animeme::dam
