// Lips that meet. Internal.
#pragma once

#include <algorithm>
#include <cstddef>

namespace animeme::fap::internal {

/// FAPs of one place on the upper and on the lower lip; their sum says by how much they close it.
struct LipPair {
  int upper;
  int lower;
};

/// The middle, left and right of it.
inline constexpr std::size_t kLipPairs = 3;
inline constexpr LipPair kLips[kLipPairs] = {{4, 5}, {8, 10}, {9, 11}};

/// Lips and lids so near are shut: share of MNS.
inline constexpr double kTouch = 0.06;

/// How far lips close that should by `closing`, FAP units of MNS, negative if they should be apart:
/// those that would nearly touch are shut.
inline double soft_closing(double closing) {
  constexpr double kUnits = kTouch * 1024;
  const double near = std::clamp((kUnits + closing) / (kUnits * 2 / 3), 0.0, 1.0);
  return closing < 0 ? closing * (1 - near * near * (3 - 2 * near)) : closing;
}

}  // namespace animeme::fap::internal
