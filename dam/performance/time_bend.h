/// @file
/// The time of a performance bent to new speech: phrases and stressed syllables of the one meet
/// those of the other.
///
///     BentTime bent = bend_time(plan_of_performance, plan_speech(script), options);
///     double moment = bent.source(1.5);      // what to show 1.5 s into the new speech
#pragma once

#include <span>
#include <vector>

#include "dam/behaviour/speech_plan.h"
#include "fap/rate.h"

namespace animeme::dam {

/// How much faster a performance is at most shown than it was played; slower: 1 / (1 + this).
inline constexpr double kMostBend = 0.25;

/// A moment of the new speech, and the moment of the performance that is shown then. Seconds.
struct BentMoment {
  double time = 0;    ///< of the new speech
  double source = 0;  ///< of the performance
  friend bool operator==(const BentMoment&, const BentMoment&) = default;
};

/// A monotone, piecewise linear map of time.
class BentTime {
 public:
  /// Both times ascend strictly from moment to moment. Without moments, both times are the same.
  explicit BentTime(std::vector<BentMoment> moments = {}) : moments_(std::move(moments)) {}
  /// The moment of the performance, seconds. Before the first and behind the last moment time runs
  /// evenly.
  double source(double time) const;
  /// Where the speed changes, in order.
  const std::vector<BentMoment>& moments() const { return moments_; }

 private:
  std::vector<BentMoment> moments_;
};

/// A stretch of a performance that keeps its own speed. Seconds of the performance.
struct OwnPace {
  double start = 0;  ///< its beginning
  double end = 0;    ///< its end, > start
};

/// Options of bend_time().
struct BendOptions {
  double length = 0;               ///< of the performance, seconds
  double wanted = 0;               ///< of the new speech, seconds
  fap::Rate rate = {25, 1};        ///< of the new clip
  double most = kMostBend;         ///< 0..kMostBend; 0: both times are the same
  std::span<const OwnPace> fixed;  ///< in order, without overlap: blinks, saccades, fast motion
};

/// Finds the map by dynamic programming. It begins at (0, 0), and the speed lies between 1 / (1 +
/// most) and 1 + most; in `fixed` it is 1. Within these limits it
///
/// - brings begins and ends of phrases, then stressed vowels, of `source` near those of `target`,
/// - lets the performance speak where the speech does,
/// - ends as near to the end of the speech as the limits allow (a performance that is more than
///   1 + most times as long as the speech runs at its own speed on average, and is cut),
/// - bends as little as it can. Where time is only shifted, it is by whole frames, so that frames
///   of the performance are shown as they are.
///
/// The last moment is where the performance ends, or behind the end of the speech. Plans may be
/// empty. Time and memory grow with the length: an hour takes about a second.
BentTime bend_time(const SpeechPlan& source, const SpeechPlan& target, const BendOptions& options);

}  // namespace animeme::dam
