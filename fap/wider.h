/// @file
/// Scales the mouth opening, for faces whose jaw has more room than a clip uses.
///
///     animeme::fap::Frame wide = animeme::fap::open_wider(frame, 1.8);
#pragma once

#include "fap/frame.h"

namespace animeme::fap {

inline constexpr double kLeastMouthGain = 0.25;  ///< lower limit of open_wider()
inline constexpr double kMostMouthGain = 4;      ///< upper limit

/// Multiplies the opening of the lips (the widest of their middle and both halves, FAP 4 and 5, 8
/// and 10, 9 and 11; without them the effect of FAP 3) by `gain`. It adds or removes a share of
/// ARKit's jawOpen (arkit.h), so chin, corners and the outer contour follow and lips stay as round
/// as they are. Closed lips stay closed, and F and V at the teeth: what opens the lips by raising
/// the upper one is not scaled, nor an opening below 3 % of that of a full jawOpen (all of it from
/// 10 % on). At most one full jawOpen is added. `gain` is clamped to
/// kLeastMouthGain..kMostMouthGain; 1 and NaN change nothing. Absent FAPs stay absent; FAP 1 and 2
/// are ignored.
Frame open_wider(const Frame& frame, double gain);

}  // namespace animeme::fap
