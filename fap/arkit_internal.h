// The numbers behind arkit.h. Not installed.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "fap/arkit.h"
#include "fap/detail/bounded_fit.h"

namespace animeme::fap::internal {

/// What a channel at 1 (shapes) or 1 rad (angles) does to one FAP, in FAP units.
using ArkitWeight = ShapeWeight;

struct ArkitShape {
  std::string_view name;
  std::span<const ArkitWeight> weights;
};

/// All channels that do anything, but shapes of the right side: they mirror the left ones.
std::span<const ArkitShape> arkit_shapes();

/// The same for all channels by number, both sides.
using ArkitWeights = std::array<std::vector<ArkitWeight>, kArkitChannelCount>;
const ArkitWeights& arkit_weights();

}  // namespace animeme::fap::internal
