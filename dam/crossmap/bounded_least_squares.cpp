#include "dam/crossmap/bounded_least_squares.h"

#include <algorithm>
#include <cmath>

namespace animeme::dam {
namespace {

// Columns of length 1: what of a column the free ones cannot make, squared; below it the column
// would be a difference of rounding errors.
constexpr double kDepends = 1e-11;
// Products this small, as a share of the largest, are rounding.
constexpr double kSmall = 2e-14;
// So often as many unknowns may be wrong as were, or more, before one at a time changes.
constexpr int kPatience = 4;

}  // namespace

BoundedLeastSquares::BoundedLeastSquares(std::span<const double> matrix, std::size_t rows,
                                         std::size_t unknowns, const LeastSquaresLimits& limits)
    : rows_(rows), n_(unknowns) {
  matrix_.assign(matrix.begin(), matrix.begin() + std::ptrdiff_t(rows_ * n_));
  gram_.assign(n_ * n_, 0.0);
  for (std::size_t i = 0; i < rows_; ++i) {
    const double* __restrict row = &matrix_[i * n_];
    for (std::size_t j = 0; j < n_; ++j) {
      const double value = row[j];
      if (value == 0) continue;
      double* __restrict sums = &gram_[j * n_];
      for (std::size_t k = 0; k <= j; ++k) sums[k] += value * row[k];
    }
  }
  scale_.assign(n_, 0.0);
  for (std::size_t j = 0; j < n_; ++j) {
    if (gram_[j * n_ + j] > 0) scale_[j] = 1 / std::sqrt(gram_[j * n_ + j]);
  }
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      gram_[j * n_ + k] = gram_[k * n_ + j] = gram_[j * n_ + k] * scale_[j] * scale_[k];
    }
    gram_[j * n_ + j] = scale_[j] > 0 ? 1 + limits.ridge : 0;
  }
  low_.resize(n_);
  room_.resize(n_);
  low_products_.assign(n_, 0.0);
  for (std::size_t j = 0; j < n_; ++j) {
    low_[j] = limits.lows.empty() ? limits.low : limits.lows[j];
    const double high = limits.highs.empty() ? limits.high : limits.highs[j];
    room_[j] = scale_[j] > 0 ? (high - low_[j]) / scale_[j] : 0;
  }
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t k = 0; k < n_; ++k) {
      if (low_[k] != 0 && scale_[k] > 0) {
        low_products_[j] += gram_[j * n_ + k] * low_[k] / scale_[k];
      }
    }
  }
  x_ = low_;
  factor_.resize(n_ * n_);
  inverse_.resize(n_);
  right_.resize(n_);
  solution_.resize(n_);
  left_.resize(n_);
  want_.resize(n_);
  barred_.resize(n_);
  restart();
}

void BoundedLeastSquares::restart() {
  y_.assign(n_, 0.0);
  at_.assign(n_, At::low);
  free_.clear();
}

std::vector<double> BoundedLeastSquares::products(std::span<const double> target) const {
  std::vector<double> result(n_, 0.0);
  double* __restrict out = result.data();
  std::size_t i = 0;
  for (; i + 4 <= rows_; i += 4) {  // fewer passes over `out`
    const double* row = &matrix_[i * n_];
    const double b0 = target[i], b1 = target[i + 1], b2 = target[i + 2], b3 = target[i + 3];
    for (std::size_t j = 0; j < n_; ++j) {
      out[j] += (row[j] * b0 + row[n_ + j] * b1) + (row[2 * n_ + j] * b2 + row[3 * n_ + j] * b3);
    }
  }
  for (; i < rows_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) out[j] += matrix_[i * n_ + j] * target[i];
  }
  return result;
}

std::span<const double> BoundedLeastSquares::fit(std::span<const double> target) {
  return fit_products(products(target));
}

// The factor of the free columns' products, whose first rows are there. Columns that depend on
// those before them go back to their low limit.
void BoundedLeastSquares::factor_from(std::size_t first) {
  for (std::size_t k = 0; k < free_.size(); ++k) {
    double* __restrict column = &factor_[k * n_];
    const double* products = &gram_[free_[k] * n_];
    const std::size_t begin = std::max(k, first), size = free_.size();
    for (std::size_t i = begin; i < size; ++i) column[i] = products[free_[i]];
    std::size_t m = 0;
    for (; m + 4 <= k; m += 4) {  // fewer passes over the column
      const double* a = &factor_[m * n_];
      const double *b = a + n_, *c = b + n_, *d = c + n_;
      const double p = a[k], q = b[k], r = c[k], s = d[k];
      for (std::size_t i = begin; i < size; ++i) {
        column[i] -= (p * a[i] + q * b[i]) + (r * c[i] + s * d[i]);
      }
    }
    for (; m < k; ++m) {
      const double* a = &factor_[m * n_];
      const double p = a[k];
      for (std::size_t i = begin; i < size; ++i) column[i] -= p * a[i];
    }
    if (k >= first && !(column[k] > kDepends)) {
      at_[free_[k]] = At::low;
      y_[free_[k]] = 0;
      barred_[free_[k]] = 1;
      depends_ = true;
      free_.erase(free_.begin() + std::ptrdiff_t(k));
      return factor_from(k);
    }
    if (k >= first) inverse_[k] = 1 / std::sqrt(column[k]);
    const double inverse = inverse_[k];
    for (std::size_t i = std::max(begin, k + 1); i < size; ++i) column[i] *= inverse;
  }
}

// What the free ones would be without limits.
void BoundedLeastSquares::solve_free() {
  ++steps_;
  const std::size_t size = solved_ = free_.size();
  for (std::size_t i = 0; i < size; ++i) right_[i] = want_[free_[i]];
  for (std::size_t j = 0; j < n_; ++j) {
    if (at_[j] != At::high) continue;
    for (std::size_t i = 0; i < size; ++i) right_[i] -= gram_[j * n_ + free_[i]] * y_[j];
  }
  double* __restrict right = right_.data();
  for (std::size_t k = 0; k < size; ++k) {
    const double* column = &factor_[k * n_];
    const double value = solution_[k] = right[k] * inverse_[k];
    for (std::size_t i = k + 1; i < size; ++i) right[i] -= value * column[i];
  }
  for (std::size_t k = size; k-- > 0;) {
    const double* column = &factor_[k * n_];
    double sums[2] = {};
    std::size_t i = k + 1;
    for (; i + 2 <= size; i += 2) {
      sums[0] += column[i] * solution_[i];
      sums[1] += column[i + 1] * solution_[i + 1];
    }
    if (i < size) sums[0] += column[i] * solution_[i];
    solution_[k] = (solution_[k] - (sums[0] + sums[1])) * inverse_[k];
  }
}

void BoundedLeastSquares::residual_products() {
  used_.clear();
  for (std::size_t k = 0; k < n_; ++k) {
    if (y_[k] != 0) used_.push_back(k);
  }
  std::copy(want_.begin(), want_.end(), left_.begin());
  double* __restrict left = left_.data();
  std::size_t m = 0;
  for (; m + 4 <= used_.size(); m += 4) {
    const double *a = &gram_[used_[m] * n_], *b = &gram_[used_[m + 1] * n_];
    const double *c = &gram_[used_[m + 2] * n_], *d = &gram_[used_[m + 3] * n_];
    const double p = y_[used_[m]], q = y_[used_[m + 1]];
    const double r = y_[used_[m + 2]], s = y_[used_[m + 3]];
    for (std::size_t j = 0; j < n_; ++j) left[j] -= (p * a[j] + q * b[j]) + (r * c[j] + s * d[j]);
  }
  for (; m < used_.size(); ++m) {
    const double* a = &gram_[used_[m] * n_];
    for (std::size_t j = 0; j < n_; ++j) left[j] -= y_[used_[m]] * a[j];
  }
}

double BoundedLeastSquares::small_product() const {
  double most = 0;
  for (const double value : want_) most = std::max(most, std::abs(value));
  return kSmall * most * std::sqrt(double(n_));
}

// How many unknowns are on the wrong side of where they belong: free ones beyond a limit, and those
// at a limit that the sum would fall without. Behind the free ones are then those to become free.
std::size_t BoundedLeastSquares::find_wrong() {
  const double small = small_product();
  for (std::size_t j = 0; j < n_; ++j) {
    if (at_[j] == At::free || barred_[j] != 0 || room_[j] <= 0) continue;
    if ((at_[j] == At::low ? left_[j] : -left_[j]) > small) free_.push_back(j);
  }
  std::size_t wrong = free_.size() - solved_;
  for (std::size_t i = 0; i < solved_; ++i) {
    wrong += solution_[i] < 0 || solution_[i] > room_[free_[i]] ? 1 : 0;
  }
  return wrong;
}

// Lets them change places.
void BoundedLeastSquares::exchange() {
  std::size_t kept = 0, first = solved_;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const std::size_t j = free_[i];
    if (i < solved_ && (solution_[i] < 0 || solution_[i] > room_[j])) {
      at_[j] = solution_[i] < 0 ? At::low : At::high;
      y_[j] = solution_[i] < 0 ? 0 : room_[j];
      first = std::min(first, i);
    } else {
      at_[j] = At::free;
      free_[kept++] = j;
    }
  }
  free_.resize(kept);
  factor_from(first);
}

// True: it is the minimum. False: going on like this might never end; y_ is within its limits.
bool BoundedLeastSquares::fit_by_blocks() {
  std::size_t fewest = n_ + 1;
  for (int patience = kPatience;;) {
    solve_free();
    for (std::size_t i = 0; i < free_.size(); ++i) y_[free_[i]] = solution_[i];
    residual_products();
    const std::size_t wrong = find_wrong();
    if (wrong == 0) return true;
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
    if (patience == 0) break;
    depends_ = false;
    exchange();
    if (depends_) break;  // one of several was left out, and who knows whether the right one
  }
  std::fill(barred_.begin(), barred_.end(), std::uint8_t(0));
  std::size_t kept = 0, first = free_.size();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const std::size_t j = free_[i];
    if (y_[j] > 0 && y_[j] < room_[j]) {
      free_[kept++] = j;
      continue;
    }
    first = std::min(first, i);
    at_[j] = y_[j] > 0 ? At::high : At::low;
    y_[j] = y_[j] > 0 ? room_[j] : 0;
  }
  free_.resize(kept);
  factor_from(std::min(first, kept));
  return false;
}

// How far towards the solution, 0..1, until one is at a limit: `hit`, its place; 1 if none.
double BoundedLeastSquares::step_to_limit(std::size_t& hit) const {
  double step = 1;
  hit = free_.size();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const double now = y_[free_[i]], then = solution_[i], room = room_[free_[i]];
    double share = 1;
    if (then < 0) {
      share = now / (now - then);
    } else if (then > room) {
      share = (room - now) / (then - now);
    } else {
      continue;
    }
    if (hit == free_.size() || share < step) {
      step = share;
      hit = i;
    }
  }
  return step;
}

void BoundedLeastSquares::fix(std::size_t place, At limit) {
  const std::size_t j = free_[place];
  at_[j] = limit;
  y_[j] = limit == At::high ? room_[j] : 0;
  free_.erase(free_.begin() + std::ptrdiff_t(place));
  factor_from(place);
}

// The one at a limit that the sum of squares falls most steeply with; false: none would help.
bool BoundedLeastSquares::set_free() {
  const double small = small_product();
  while (true) {
    double best = small;
    std::size_t chosen = n_;
    for (std::size_t j = 0; j < n_; ++j) {
      if (at_[j] == At::free || barred_[j] != 0 || room_[j] <= 0) continue;
      const double gain = at_[j] == At::low ? left_[j] : -left_[j];
      if (gain > best) {
        best = gain;
        chosen = j;
      }
    }
    if (chosen == n_) return false;
    const At before = at_[chosen];
    const double value = y_[chosen];
    at_[chosen] = At::free;
    free_.push_back(chosen);
    factor_from(free_.size() - 1);
    if (at_[chosen] == At::free) return true;
    at_[chosen] = before;  // the free ones can make it: it stays where it is
    y_[chosen] = value;
  }
}

void BoundedLeastSquares::fit_by_steps() {
  const std::size_t most = steps_ + 20 * n_ + 100;  // against rounding that goes in circles
  std::size_t last = n_;                            // set free just now
  while (steps_ < most) {
    solve_free();
    std::size_t hit = 0;
    const double step = step_to_limit(hit);
    const bool arrived = hit == free_.size();
    for (std::size_t i = 0; i < free_.size(); ++i) {
      double& y = y_[free_[i]];
      y = arrived ? solution_[i] : y + step * (solution_[i] - y);
      y = std::clamp(y, 0.0, room_[free_[i]]);
    }
    if (!arrived) {
      const std::size_t j = free_[hit];
      // Set free and back at once: what pulled it was rounding.
      if (j == last && step <= 0) barred_[j] = 1;
      fix(hit, solution_[hit] < 0 ? At::low : At::high);
      continue;
    }
    residual_products();
    if (!set_free()) return;
    last = free_.back();
  }
}

std::span<const double> BoundedLeastSquares::fit_products(std::span<const double> products) {
  for (std::size_t j = 0; j < n_; ++j) want_[j] = products[j] * scale_[j] - low_products_[j];
  std::fill(barred_.begin(), barred_.end(), std::uint8_t(0));
  steps_ = 0;
  if (!fit_by_blocks()) fit_by_steps();
  for (std::size_t j = 0; j < n_; ++j) {
    // Limits exactly, whatever the scale makes of them.
    const double high = scale_[j] > 0 ? low_[j] + room_[j] * scale_[j] : low_[j];
    x_[j] = at_[j] == At::low ? low_[j] : std::min(low_[j] + y_[j] * scale_[j], high);
  }
  return x_;
}

}  // namespace animeme::dam
