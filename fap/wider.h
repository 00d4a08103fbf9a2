/// @file
/// A mouth that opens wider: for faces whose jaw has more room than a clip uses.
///
///     animeme::fap::Frame wide = animeme::fap::open_wider(frame, 1.8);
#pragma once

#include "fap/frame.h"

namespace animeme::fap {

inline constexpr double kLeastMouthGain = 0.25;  ///< what open_wider() takes at least
inline constexpr double kMostMouthGain = 4;      ///< and at most

/// The opening of the lips (the widest of their middle and both halves, FAP 4 and 5, 8 and 10, 9
/// and 11; without them what FAP 3 lowers) becomes `gain` times as wide: what is added, or taken
/// away, is a share of ARKit's jawOpen (arkit.h), so chin, corners and the outer contour go along
/// and lips stay as round as they are. Shut lips stay shut. No more is added than to one full
/// jawOpen. `gain` is clamped to kLeastMouthGain..kMostMouthGain; 1 and NaN change nothing. FAPs
/// that the frame does not have stay absent; FAP 1 and 2 are not looked at.
Frame open_wider(const Frame& frame, double gain);

}  // namespace animeme::fap
