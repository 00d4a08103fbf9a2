/// @file
/// Which channels a mirror exchanges, so that a resting mouth is the same on both sides.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace animeme::dam {

/// The channel that a mirrored face has in place of another one.
struct MirroredChannel {
  std::size_t channel = 0;  ///< index among the names; its own one if no other side is there
  double sign = 1;          ///< -1: what points to one side of the world changes its direction
};

/// One of each name. FAPs ("fap12_...") by the table of the standard; ARKit's shapes and all other
/// names by "Left" and "Right", or "_L" and "_R", at their end. A channel without another side is
/// its own mirror image.
std::vector<MirroredChannel> mirrored_channels(std::span<const std::string> names);

}  // namespace animeme::dam
