#include "dam/maths/spline.h"

#include <algorithm>
#include <utility>

namespace animeme::dam {

Spline::Spline(std::vector<double> samples)
    : samples_(std::move(samples)), curvature_(samples_.size(), 0.0) {
  const std::size_t n = samples_.size();
  if (n < 3) return;
  // Thomas algorithm for c[i-1] + 4 c[i] + c[i+1] = 6 (y[i-1] - 2 y[i] + y[i+1]), ends 0.
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 4 - upper[i - 1];
    const double right = 6 * (samples_[i - 1] - 2 * samples_[i] + samples_[i + 1]);
    upper[i] = 1 / pivot;
    curvature_[i] = (right - curvature_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) curvature_[i] -= upper[i] * curvature_[i + 1];
}

double Spline::operator()(double x) const {
  const std::size_t last = samples_.size() - 1;
  if (!(x > 0)) return samples_.front();
  if (x >= double(last)) return samples_.back();
  const auto i = std::min(std::size_t(x), last - 1);
  const double b = x - double(i), a = 1 - b;
  return a * samples_[i] + b * samples_[i + 1] +
         ((a * a * a - a) * curvature_[i] + (b * b * b - b) * curvature_[i + 1]) / 6;
}

}  // namespace animeme::dam
