// Ways up and down without a corner.
#pragma once

#include <cmath>
#include <numbers>

namespace animeme::dam {

/// 0 at x <= 0, 1 at x >= 1, a raised cosine between.
inline double raised_step(double x) {
  if (x <= 0) return 0;
  return x >= 1 ? 1.0 : 0.5 * (1 - std::cos(std::numbers::pi * x));
}

/// 1 at x = 0, 0 at |x| >= 1, a raised cosine between.
inline double raised_bell(double x) {
  return std::abs(x) >= 1 ? 0.0 : 0.5 * (1 + std::cos(std::numbers::pi * x));
}

}  // namespace animeme::dam
