/// @file
/// A performance: the motion of a face that somebody played, to be kept while it says something
/// else.
///
///     auto performance = Performance::make(clip, script_of_clip);
///     performance->value(31, 0.5);        // the brow at half a second
///     performance->slow(12, 0.5);         // the corner of the mouth, without its speech
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "dam/behaviour/speech_plan.h"
#include "dam/performance/time_bend.h"
#include "dam/script/script.h"
#include "fap/edit.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::dam {

/// How much of a performance is kept, by FAP: 0 to 1. The names of the groups are those of
/// fap::regions().
struct KeptShares {
  std::array<double, fap::kFapCount + 1> of{};  ///< by number of the FAP

  /// All of brows, lids, gaze, cheeks, nose, head and ears, and of the slow part of the lips. Jaw
  /// and tongue are those of the new speech.
  KeptShares();
  /// Sets the share of these FAPs, 0..1.
  void set(const fap::Mask& faps, double share);
  friend bool operator==(const KeptShares&, const KeptShares&) = default;
};

/// FAPs that belong to speech: those of the groups lips, jaw and tongue.
const fap::Mask& spoken_faps();

/// Values are held in the frames' own rate; copies are independent. Immutable.
class Performance {
 public:
  /// `clip`: complete frames (fap/fill.h) without FAP 1 and 2, numbered from 0; they are shown as
  /// FAPs before (FillOptions::expand). `script`: what is said in it, if that is known, on a clock
  /// where the first frame is shown at `start` seconds (0 or more; the first pose is held before
  /// it). Without a script, pauses and stressed syllables are read from the motion of jaw and lips,
  /// if that moves as in speech. Errors: truncated (no frames), invalid_argument (`start`, the
  /// rate).
  static Result<Performance> make(fap::Sequence clip, const Script& script = {}, double start = 0);

  /// Frames per second.
  const fap::Rate& rate() const { return clip_.rate; }
  /// From 0 to the end of its last frame.
  double seconds() const { return start_ + clip_.rate.seconds(double(clip_.frames.size())); }
  /// The FAPs that it has. A group (fap::regions()) that rests all the time counts as absent, and
  /// so do all of its FAPs; one that moves is complete: FAPs that were not sent rest.
  const fap::Mask& faps() const { return faps_; }
  /// The value of a FAP at a time, in its units, interpolated linearly; exact in its own frames.
  /// The ends are held. Lids are at their most closed within `window` seconds on both sides, so
  /// that a blink of one frame closes at other rates, too.
  double value(int fap, double seconds, double window = 0) const;
  /// The slow part of a FAP of the lips or the jaw: a smile, without the motion of speech. Lips are
  /// not apart, except where they never come near each other within a second.
  double slow(int fap, double seconds) const;
  /// Phrases and stressed vowels, for bend_time().
  const SpeechPlan& plan() const { return plan_; }
  /// Blinks, saccades, and where anything that is not the mouth moves near its fastest: stretches
  /// that have to keep their speed, in order.
  const std::vector<OwnPace>& own_pace() const { return own_pace_; }
  /// The largest change of a FAP in 1 s, from frame to frame, in its units.
  double fastest(int fap) const { return fastest_[std::size_t(fap)]; }

 private:
  Performance() = default;
  double frame_at(double seconds) const;
  void find_faps();
  void find_slow();
  void find_own_pace();
  void find_plan(const Script& script);

  fap::Sequence clip_;
  double start_ = 0;
  fap::Mask faps_;
  SpeechPlan plan_;
  std::vector<OwnPace> own_pace_;
  std::array<double, fap::kFapCount + 1> fastest_{};
  std::array<std::vector<float>, fap::kFapCount + 1> slow_;  // one value a kSlowStep
};

}  // namespace animeme::dam
