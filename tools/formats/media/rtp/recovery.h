/// @file
/// What of a received face can be shown. A predictive plane holds differences to the plane before
/// it, so after a loss everything up to the next intra plane is wrong and is left out here.
///
///     FaceRecovery recovery;
///     while (auto event = source->next(1.0)) {
///       if (auto unit = recovery.accept(*event)) play(*unit);
///     }
///
/// For all transports. Source: tools/formats/media/containers.md, section 4.2.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// An intra plane and what follows it up to the next one that was received.
struct IntraInterval {
  std::int64_t begin = 0;   ///< time of the intra plane, ticks of LiveInfo::timescale
  std::int64_t planes = 0;  ///< received and lost; exact if each packet carries one plane
  std::int64_t usable = 0;  ///< of these, those that accept() gave out

  friend bool operator==(const IntraInterval&, const IntraInterval&) = default;
};

/// Totals.
struct RecoveryStats {
  std::int64_t usable = 0;     ///< planes given out
  std::int64_t dropped = 0;    ///< planes received that could not be used
  std::int64_t lost = 0;       ///< packets of the face that are missing; unknown numbers count as 1
  std::int64_t freezes = 0;    ///< times without a plane, from a usable one to the next intra plane
  double frozen_seconds = 0;   ///< all of them together
  double longest_seconds = 0;  ///< the longest

  /// Share of planes that could be used; 1 if there were none.
  double share() const {
    const std::int64_t all = usable + dropped + lost;
    return all > 0 ? double(usable) / double(all) : 1;
  }
};

/// Passes on the planes that can be decoded, and keeps count.
class FaceRecovery {
 public:
  /// Takes the events of a source in their order. Gives back sound as it is, and planes that can be
  /// decoded: from the first intra plane on, and after a gap from the next one on. A new
  /// configuration or time scale counts as a gap, and so does another sender.
  std::optional<LiveUnit> accept(LiveEvent event);

  /// Is the face wrong or unknown since the last gap?
  bool waiting() const { return waiting_; }
  const RecoveryStats& stats() const { return stats_; }  ///< totals
  /// Intervals that are complete (LiveEnd completes the last), oldest first; each is given once. Of
  /// those that nobody takes the last 4096 are kept.
  std::vector<IntraInterval> take_intervals();

 private:
  std::optional<LiveUnit> accept_plane(LiveUnit unit);
  void lose(std::int64_t packets);
  void begin_interval(const LiveUnit& unit);
  void end_interval();

  bool waiting_ = true;
  std::optional<LiveInfo> info_;
  std::optional<double> shown_until_;  // ticks: end of the last usable plane
  std::optional<IntraInterval> interval_;
  std::deque<IntraInterval> complete_;
  RecoveryStats stats_;
};

}  // namespace animeme::media
