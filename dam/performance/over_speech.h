/// @file
/// New speech over a kept performance: lips, jaw and tongue of the speech; brows, lids, gaze, head,
/// nose and ears of the performance; cheeks and a smile as far as the sounds allow.
///
///     Signal signal = synthesise(model, script).value();
///     auto report = speak_over(signal, script, performance, {});
///     fap::Sequence clip = to_sequence(signal).value();
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "dam/performance/performance.h"
#include "dam/performance/time_bend.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "fap/result.h"

namespace animeme::dam {

/// Options of speak_over().
struct OverOptions {
  KeptShares keep = {};     ///< what is kept of the performance
  double bend = kMostBend;  ///< 0..kMostBend: how much faster or slower its time may run
  /// Idle motion of the groups that the performance does not have, or that are not kept, and of all
  /// groups where it has ended; nullopt: these rest.
  std::optional<IdleMotionOptions> idle = IdleMotionOptions();
};

/// Result of speak_over().
struct OverReport {
  BentTime time;     ///< which moment of the performance is shown when
  double end = 0;    ///< seconds of the clip at which the performance ends; at most its length
  fap::Mask kept;    ///< FAPs that come from the performance, the slow part of the lips included
  fap::Mask filled;  ///< FAPs of idle motion alone
};

/// Puts a performance over a signal of FAPs that speaks `script`.
///
/// - FAPs of the groups brows, lids, gaze, nose, head and ears are those of the performance: where
///   its time is only shifted by whole frames and both rates are the same, value for value. A share
///   s below 1 leaves 1 - s to the idle motion (or to what the model has learned).
/// - Its time is bent (time_bend.h). Where it has ended, idle motion goes on from its last pose:
///   the pose fades over 0.6 s or more, no faster than a quarter of the performance's fastest
///   motion. Where it is too long, its end is cut off.
/// - The slow part of its lips (Performance::slow) is added as the mouth of a mood is (moods.h): P,
///   B and M close, F and V keep the lip at the teeth, rounded sounds stay rounded. Cheeks that are
///   puffed lose their air while the mouth speaks.
/// - FAPs that neither speech nor performance have get idle motion, as add_idle_motion() adds it.
///
/// Channels are added as needed; a signal of ARKit's shapes becomes one of FAPs. Call it before
/// add_moods(). The signal must begin at frame 0. Errors: invalid_argument (a part of a stream,
/// `bend` or a share out of range), unsupported (neither FAPs nor ARKit's shapes), those of
/// Behaviour::make().
Result<OverReport> speak_over(Signal& signal, const Script& script, const Performance& performance,
                              const OverOptions& options = {});

/// A performance that repeats for as long as a live head runs, at its own speed. Where it begins
/// again, the difference between its last and its first pose fades as at the end in speak_over().
class PerformanceLoop {
 public:
  /// `rate`: frames per second of the head.
  PerformanceLoop(std::shared_ptr<const Performance> performance, const KeptShares& keep,
                  const fap::Rate& rate);
  /// The FAPs that it moves.
  const fap::Mask& faps() const { return kept_; }
  /// Puts the next moment over a frame that has speech and idle motion. `shares`: what the sounds
  /// leave to the lips now.
  void next(const MoodMouth::Shares& shares, fap::Frame& frame);

 private:
  struct Fade {
    double pose = 0, seconds = 1;
  };
  double kept_value(int fap, double moment) const;

  std::shared_ptr<const Performance> performance_;
  KeptShares keep_;
  fap::Mask kept_;
  double frame_;            // seconds
  std::int64_t count_ = 0;  // frames since it began again
  bool repeated_ = false;   // it has been shown once
  std::array<Fade, fap::kFapCount + 1> fades_{};
  std::array<double, fap::kFapCount + 1> shown_{};
};

}  // namespace animeme::dam
