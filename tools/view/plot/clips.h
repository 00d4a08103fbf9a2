/// @file
/// Rows of a plot that show FAPs of clips.
#pragma once

#include <vector>

#include "fap/frame.h"
#include "tools/view/plot/curves.h"

namespace animeme::plot {

/// A filled clip (fap/fill.h), and when its frame 0 is shown.
struct TimedClip {
  fap::Sequence clip;  ///< filled
  double start = 0;    ///< seconds

  double end() const { return start + clip.duration(); }  ///< seconds
};

/// FAP `fap`, 3 to 68, of up to three clips, a curve each in the order of the clips; no number
/// where a frame does not have it, and a row without any says so.
Row fap_row(int fap, const std::vector<TimedClip>& clips);

/// b less a in the third colour, at the times of a; what b shows at a time is its last frame so
/// far, its first one if it has not begun. No points if b has no frames.
Row difference_row(int fap, const TimedClip& a, const TimedClip& b);

}  // namespace animeme::plot
