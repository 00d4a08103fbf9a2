// The units of tables of ARKit shapes: shares or percent, radians or degrees.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fap/arkit.h"

namespace animeme::exchange {

/// Brings rows of a table to the units of fap::ArkitFrame, in place:
///
/// - Weights from 0 to 100, as Unity, iFacialMocap and SRanipal have them, become shares: where at
///   least a tenth of the weights that are not at rest exceed 1.5, and none 200.
/// - Angles in degrees become radians: if `degrees`, or where at least a hundredth of the angles
///   exceed half a turn, which no head and no eye can.
///
/// Says so in `warnings`, and names weights far beyond 1 that are kept.
void to_usual_units(std::span<fap::ArkitFrame> rows, bool degrees,
                    std::vector<std::string>& warnings);

}  // namespace animeme::exchange
