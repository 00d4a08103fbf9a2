// Derivatives of series by central differences, and where they can be taken.
#pragma once

#include <cstddef>
#include <vector>

namespace animeme::dam {

/// Frames on each side that a derivative of order 1, 2 or 3 takes.
inline constexpr std::size_t kReach[] = {0, 1, 1, 2};

/// Per frame^order. `i` has kReach[order] frames on both sides.
inline double derivative(const std::vector<double>& x, std::size_t i, int order) {
  if (order == 1) return (x[i + 1] - x[i - 1]) / 2;
  if (order == 2) return x[i + 1] - 2 * x[i] + x[i - 1];
  return (x[i + 2] - 2 * x[i + 1] + 2 * x[i - 1] - x[i - 2]) / 2;
}

}  // namespace animeme::dam
