/// @file
/// Signals whose channels are ARKit's blend shapes and angles, by name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dam/signal/signal.h"
#include "fap/arkit.h"
#include "fap/result.h"

namespace animeme::dam {

/// Which channel of a signal is which of ARKit's.
struct ArkitLayout {
  std::vector<int> channel;  ///< one a name: channel of fap/arkit.h, -1: none of them
  fap::ArkitChannels has;    ///< those that are there

  /// The values of a row of the signal, by ARKit's channel; those that are not there are 0.
  fap::ArkitFrame frame(std::span<const double> row) const;
};

/// Nothing if no name is a shape or an angle of ARKit. Of names for one channel ("jawOpen",
/// "JawOpen") the first counts.
std::optional<ArkitLayout> find_arkit_layout(std::span<const std::string> names);

/// A channel of ARKit spelled as `names` spell theirs: "EyeBlinkLeft" beside "JawOpen",
/// "eyeBlink_L" beside "mouthSmile_L", else ARKit's own.
std::string arkit_spelling(int channel, std::span<const std::string> names);

}  // namespace animeme::dam
