// A value by its rank.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace animeme::fap::detail {

/// The value that `share` (0 to 1) of the values lie below: that of the nearest rank; 0 without
/// values. Reorders them.
template <class Number>
Number quantile(std::vector<Number>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ptrdiff_t(std::lround(share * double(values.size() - 1)));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace animeme::fap::detail
