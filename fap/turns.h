/// @file
/// Turns of the head and of the eyes between the steps of a quantiser.
///
/// An FBA stream with quantiser 1 codes FAP 48 to 50 in steps of 0.097 degrees and FAP 23 to 26 in
/// steps of 0.073: in a slow turn at 60 frames a second most frames repeat the one before, and
/// then the head ticks. Players ease these FAPs with the functions below. What is eased never
/// differs by more than half a step from what is coded, which is all that the coder left open, so
/// nothing comes later than it is.
///
/// The step is found in the values: the greatest number that divides them all. Values in steps of
/// less than 0.034 degrees (a capture, say) need no easing, and those above 1.1 degrees are taken
/// for positions of their own; both stay as they are.
#pragma once

#include <array>
#include <cstdint>

#include "fap/frame.h"

namespace animeme::fap {

/// The FAPs that are eased: gaze and head, all in units of 1e-5 rad.
inline constexpr std::array<int, 7> kTurnFaps = {23, 24, 25, 26, 48, 49, 50};

/// For streams: frame by frame, without looking ahead.
///
///     TurnSmoother turns;
///     for (;;) show(turns.next(receive()));
///
/// Follows the value and its speed (an alpha-beta filter), and stays within half a step. Begins at
/// the third change of a value, when the step is known well enough.
/// Deterministic.
class TurnSmoother {
 public:
  /// The same frame with eased turns. FAPs outside its mask stay as they are and are forgotten.
  Frame next(const Frame& frame);
  /// Forgets what came before: the next frame is shown as it is.
  void restart() { *this = TurnSmoother(); }

 private:
  struct Turn {
    std::int32_t step = 0;   // that divides all values, 0: all were 0
    std::int32_t coded = 0;  // last
    int changes = 0;         // of what is coded, counted up to kCertain
    double value = 0;        // shown last
    double speed = 0;        // a frame
  };
  std::array<Turn, kTurnFaps.size()> turns_ = {};
};

/// For clips: eases all frames, looking forwards and backwards, which is smoother. Frames whose
/// numbers leave a gap are eased as if there were none. Linear in the number of frames.
void smooth_turns(Sequence& clip);

}  // namespace animeme::fap
