// Curves that a head was drawn with beside those that a tracker saw in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/signal/signal.h"

namespace animeme::test {

/// Values of a FAP, frame after frame; empty: the signal has none.
inline std::vector<double> curve_of(const dam::Signal& signal, int fap) {
  std::vector<double> values;
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    if (dam::fap_of_channel(signal.names[c]) != fap) continue;
    for (std::size_t i = 0; i < signal.frames(); ++i) values.push_back(signal.at(i, c));
  }
  return values;
}

/// How far the lips are apart in the middle, FAP units; empty without FAP 4 and 5.
inline std::vector<double> lip_gap(const dam::Signal& signal) {
  std::vector<double> values;
  const auto lips = dam::inner_lip_channels(signal.names);
  for (std::size_t i = 0; lips && i < signal.frames(); ++i) {
    values.push_back(dam::inner_gap(signal, i, *lips));
  }
  return values;
}

/// Of the frames that both have.
struct Agreement {
  double correlation = 0;
  double gain = 0;  ///< of `seen` over `drawn`, by least squares with an offset
};
inline Agreement agreement(const std::vector<double>& drawn, const std::vector<double>& seen) {
  const std::size_t count = std::min(drawn.size(), seen.size());
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < count; ++i) a += drawn[i], b += seen[i];
  a /= double(count), b /= double(count);
  for (std::size_t i = 0; i < count; ++i) {
    aa += (drawn[i] - a) * (drawn[i] - a);
    bb += (seen[i] - b) * (seen[i] - b);
    ab += (drawn[i] - a) * (seen[i] - b);
  }
  return {ab / std::sqrt(aa * bb), ab / aa};
}

}  // namespace animeme::test
