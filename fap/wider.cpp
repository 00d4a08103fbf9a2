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
struct Opening {
  double lips = 0;
  double lower = 0;  // of that, where it is widest: by the lower lip, which goes with the jaw
};

Opening opening_of(const Frame& frame) {
  const Frame& full = full_jaw_open();
  double most = 0, lower_part = 0;
  bool lips = false;
  for (const auto& [upper, lower] : internal::kLips) {
    const auto u = std::size_t(upper), l = std::size_t(lower);
    if (!frame.mask[u] && !frame.mask[l]) continue;
    lips = true;
    const double closing =
        (frame.mask[u] ? double(frame.value[u]) : 0) + (frame.mask[l] ? double(frame.value[l]) : 0);
    const double open = closing / (double(full.value[u]) + double(full.value[l]));
    if (open <= most) continue;
    most = open;
    lower_part = frame.mask[l] ? double(frame.value[l]) / full.value[l] : 0;
  }
  if (!lips && frame.mask[3]) {
    most = lower_part = std::max(0.0, double(frame.value[3]) / full.value[3]);
  }
  return {most, lower_part};
}

// What is open by the jaw, 0 to 1: in F and V the upper lip shows the teeth and the lower one stays
// at them (on grid_s1 0.34 of the opening is the lower lip's; of S, the next one, 0.59).
double share_of_jaw(const Opening& opening) {
  constexpr double kAtTeeth = 0.4, kByJaw = 0.55;
  if (!(opening.lips > 0)) return 1;
  return std::clamp((opening.lower / opening.lips - kAtTeeth) / (kByJaw - kAtTeeth), 0.0, 1.0);
}

// Lips that nearly touch, as in a V between vowels, are near on purpose.
double share_of_open(const Opening& opening) {
  constexpr double kNear = 0.03, kOpen = 0.1;
  const double share = std::clamp((opening.lips - kNear) / (kOpen - kNear), 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

}  // namespace

Frame open_wider(const Frame& frame, double gain) {
  if (std::isnan(gain) || gain == 1) return frame;
  const Opening opening = opening_of(frame);
  const double wanted = opening.lips * std::clamp(gain, kLeastMouthGain, kMostMouthGain);
  const double more = share_of_jaw(opening) * share_of_open(opening) *
                      (std::min(wanted, std::max(opening.lips, 1.0)) - opening.lips);
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
