/// @file
/// One dominated animeme: the dominance of Eq. 1 times a polynomial. Plain functions of the local
/// time u = (t - start) / duration, so u is 0 where the phone starts and 1 where it ends.
/// Source: the paper, sections III and V.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace animeme::dam {

/// The small constant of Eq. 1 that keeps the division defined for sigma = 0.
inline constexpr double kDominanceEpsilon = 1e-6;
/// Dominances below this count as 0: such a phone does not contribute to a frame.
inline constexpr double kDominanceCut = 1e-5;

/// Distance from the phone in local time: 0 inside [0, 1].
inline double outside(double u) { return u < 0 ? -u : (u > 1 ? u - 1 : 0.0); }

/// D(u) of Eq. 1: 1 inside the phone, a Gaussian fall-off of width `sigma` (> 0, local time)
/// on both sides.
inline double dominance(double u, double sigma) {
  const double x = outside(u);
  return x == 0 ? 1.0 : std::exp(-x * x / (sigma * sigma + kDominanceEpsilon));
}

/// dD / d(log sigma), the derivative that the Gauss-Newton step of Eq. 8 and 9 needs.
inline double dominance_slope(double u, double sigma) {
  const double x = outside(u), s2 = sigma * sigma, w = s2 + kDominanceEpsilon;
  return x == 0 ? 0.0 : 2.0 * x * x * s2 / (w * w) * std::exp(-x * x / w);
}

/// Sums of dominances below this are not used as divisors: no phone reaches the frame.
inline constexpr double kLeastDominanceSum = 1e-12;

/// Local time beyond which D < kDominanceCut, as a distance from the phone.
inline double dominance_reach(double sigma) {
  return std::sqrt((sigma * sigma + kDominanceEpsilon) * -std::log(kDominanceCut));
}

/// Clamps the local time of the polynomial outside the phone to [-margin, 1 + margin]. An infinite
/// margin gives the form of the paper, which extrapolates freely.
inline double clamp_local_time(double u, double margin) {
  return std::clamp(u, -margin, 1 + margin);
}

/// sum_m a[m] u^m (Eq. 3), and its first and second derivative by u.
inline double polynomial(std::span<const double> a, double u) {
  double value = 0;
  for (std::size_t m = a.size(); m-- > 0;) value = value * u + a[m];
  return value;
}
/// Its first derivative.
inline double polynomial_slope(std::span<const double> a, double u) {
  double value = 0;
  for (std::size_t m = a.size(); m-- > 1;) value = value * u + double(m) * a[m];
  return value;
}
/// Its second derivative.
inline double polynomial_curvature(std::span<const double> a, double u) {
  double value = 0;
  for (std::size_t m = a.size(); m-- > 2;) value = value * u + double(m * (m - 1)) * a[m];
  return value;
}

}  // namespace animeme::dam
