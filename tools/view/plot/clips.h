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

/// The spectrum of the motion of FAP `fap` of up to three clips: power density in decibels (0: one
/// unit squared a hertz, of degrees for angles) over the frequency in hertz, from the mean of
/// periodograms with a Hann window of four seconds, or of the length of a shorter clip, that
/// overlap by half. Frames that lack the FAP repeat its last value. No points below a tenth of a
/// second. Frequencies go up to `most`; below -20 dB it counts as -20.
Row spectrum_row(int fap, const std::vector<TimedClip>& clips, double most);

/// b minus a in the third colour, at the times of a; b contributes its last frame at that time, or
/// its first one before it begins. No points if b has no frames.
Row difference_row(int fap, const TimedClip& a, const TimedClip& b);

}  // namespace animeme::plot
