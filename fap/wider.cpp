#include "fap/wider.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fap/arkit.h"
#include "fap/detail/lips.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

const Frame& full_jaw_open() {
  static const Frame shape = [] {
    ArkitFrame weights{};
    weights[std::size_t(find_arkit("jawOpen").value_or(0))] = 1;
    return arkit_to_fap(weights, kAllArkit);
  }();
  return shape;
}

// As a share of the one of a full jawOpen.
double opening_of(const Frame& frame) {
  const Frame& full = full_jaw_open();
  double most = 0;
  bool lips = false;
  for (const auto& [upper, lower] : internal::kLips) {
    const auto u = std::size_t(upper), l = std::size_t(lower);
    if (!frame.mask[u] && !frame.mask[l]) continue;
    lips = true;
    const double closing =
        (frame.mask[u] ? double(frame.value[u]) : 0) + (frame.mask[l] ? double(frame.value[l]) : 0);
    most = std::max(most, closing / (double(full.value[u]) + double(full.value[l])));
  }
  if (!lips && frame.mask[3]) most = std::max(0.0, double(frame.value[3]) / full.value[3]);
  return most;
}

}  // namespace

Frame open_wider(const Frame& frame, double gain) {
  if (std::isnan(gain) || gain == 1) return frame;
  const double opening = opening_of(frame);
  const double wanted = opening * std::clamp(gain, kLeastMouthGain, kMostMouthGain);
  const double more = std::min(wanted, std::max(opening, 1.0)) - opening;
  if (more == 0) return frame;
  Frame wide = frame;
  const Frame& full = full_jaw_open();
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (!wide.mask[fap] || full.value[fap] == 0) continue;
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    const double moved = double(wide.value[fap]) + std::round(more * full.value[fap]);
    wide.value[fap] = std::int32_t(std::clamp(moved, -kMost, kMost));
  }
  return wide;
}

}  // namespace animeme::fap
