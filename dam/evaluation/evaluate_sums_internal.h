// Running sums, order statistics and derivatives for scores. Internal to evaluation.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace animeme::dam {

/// Running sums for the comparison of two series: a made, b recorded.
struct Comparison {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, error = 0, largest = 0;

  void add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
    error += (a - b) * (a - b);
    largest = std::max(largest, std::abs(a - b));
  }
  double rmse() const { return n > 0 ? std::sqrt(error / n) : 0; }
  double correlation() const {
    const double vx = variation_a(), vy = variation_b();
    if (!(n > 0) || !(vx > 0) || !(vy > 0)) return 0;
    return (xy - x * y / n) / std::sqrt(vx * vy);
  }
  double deviation_a() const { return n > 0 ? std::sqrt(variation_a() / n) : 0; }
  double deviation_b() const { return n > 0 ? std::sqrt(variation_b() / n) : 0; }
  double mean_difference() const { return n > 0 ? (x - y) / n : 0; }
  /// The line b = offset + gain a of least error, and that error.
  double gain() const { return std::max(0.0, correlation()) * inverse_ratio(); }
  double offset() const { return n > 0 ? (y - gain() * x) / n : 0; }
  double fitted_nrmse() const {  ///< in deviations of b
    const double r = std::max(0.0, correlation());
    return deviation_b() > 0 ? std::sqrt(std::max(0.0, 1 - r * r)) : 0;
  }
  /// Deviation of a over that of b, 0 if b does not move.
  double deviation_ratio() const { return deviation_b() > 0 ? deviation_a() / deviation_b() : 0; }

 private:
  // Sums of squares about the mean; what rounding leaves of a constant is 0.
  static double variation(double n, double sum, double squares) {
    const double v = squares - sum * sum / n;
    return n > 0 && v > 1e-12 * squares ? v : 0;
  }
  double inverse_ratio() const { return deviation_a() > 0 ? deviation_b() / deviation_a() : 0; }
  double variation_a() const { return variation(n, x, xx); }
  double variation_b() const { return variation(n, y, yy); }
};

/// The value below which `share` (0..1) of the values lie, between neighbours by a straight line;
/// 0 for no values. Sorts them.
inline double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double at = share * double(values.size() - 1);
  const auto low = std::size_t(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - double(low)) * (values[high] - values[low]);
}

/// Frames on each side that a derivative of order 1, 2 or 3 takes.
inline constexpr std::size_t kReach[] = {0, 1, 1, 2};

/// Per frame^order. `i` has kReach[order] frames on both sides.
inline double derivative(const std::vector<double>& x, std::size_t i, int order) {
  if (order == 1) return (x[i + 1] - x[i - 1]) / 2;
  if (order == 2) return x[i + 1] - 2 * x[i] + x[i - 1];
  return (x[i + 2] - 2 * x[i + 1] + 2 * x[i - 1] - x[i - 2]) / 2;
}

}  // namespace animeme::dam
