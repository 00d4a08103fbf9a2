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

/// Maps the channels of a signal to those of ARKit.
struct ArkitLayout {
  std::vector<int> channel;  ///< per name: channel of fap/arkit.h, -1: none of them
  fap::ArkitChannels has;    ///< those that are present

  /// The values of a row of the signal, by ARKit channel; absent ones are 0.
  fap::ArkitFrame frame(std::span<const double> row) const;
};

/// nullopt if no name is an ARKit shape or angle. Of several names for one channel ("jawOpen",
/// "JawOpen") the first counts.
std::optional<ArkitLayout> find_arkit_layout(std::span<const std::string> names);

/// The name of an ARKit channel in the spelling of `names`: "EyeBlinkLeft" with "JawOpen",
/// "eyeBlink_L" with "mouthSmile_L", else ARKit's own.
std::string arkit_spelling(int channel, std::span<const std::string> names);

}  // namespace animeme::dam
