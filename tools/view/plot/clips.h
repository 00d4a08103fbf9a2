/// @file
/// Rows of a plot that show FAPs of clips.
#pragma once

#include <vector>

#include "fap/frame.h"
#include "tools/view/plot/curves.h"

namespace animeme::plot {

/// A filled clip (fap/fill.h) and the time of its frame 0.
struct TimedClip {
  fap::Sequence clip;  ///< filled
  double start = 0;    ///< seconds

  double end() const { return start + clip.duration(); }  ///< seconds
};

/// FAP `fap`, 3 to 68, of up to three clips, one curve per clip; NaN if a frame lacks it. A row
/// without values says so.
Row fap_row(int fap, const std::vector<TimedClip>& clips);

/// b minus a in the third colour, at the times of a; b contributes its last frame at that time, or
/// its first one before it begins. No points if b has no frames.
Row difference_row(int fap, const TimedClip& a, const TimedClip& b);

}  // namespace animeme::plot
