// Axes of curves.
#pragma once

#include <vector>

#include "tools/view/plot/curves.h"

namespace animeme::plot {

inline constexpr double kLeft = 150;  // pixels to the left of the curves

// The time axis that all panels share.
struct Axis {
  double begin = 0;
  double end = 0;
  double scale = 1;  // pixels a second

  double x(double seconds) const { return kLeft + (seconds - begin) * scale; }
  bool shows(double seconds) const { return seconds >= begin && seconds <= end; }
};

/// Values of a unit, from tick to tick.
struct Scale {
  double low = 0, high = 0, step = 1;
};

/// One for each row: rows of one unit share theirs, so that they can be compared. 0 is always on
/// it.
std::vector<Scale> scales_of(const Panel& panel, const Axis& axis);

}  // namespace animeme::plot
