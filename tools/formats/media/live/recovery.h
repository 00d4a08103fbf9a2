/// @file
/// Selects the received planes that can be shown. A predicted plane has differences to the previous
/// plane, so after a loss everything up to the next intra plane is wrong and is dropped here.
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
  std::int64_t usable = 0;  ///< of these, those that accept() returned

  friend bool operator==(const IntraInterval&, const IntraInterval&) = default;
};

/// Totals.
struct RecoveryStats {
  std::int64_t usable = 0;     ///< planes returned
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
  /// Takes the events of a source in order. Returns sound unchanged, and planes that can be
  /// decoded: from the first intra plane, and after a gap from the next one. A new configuration or
  /// time scale counts as a gap, and so does another sender.
  std::optional<LiveUnit> accept(LiveEvent event);

  /// Is the face wrong or unknown since the last gap?
  bool waiting() const { return waiting_; }
  const RecoveryStats& stats() const { return stats_; }  ///< totals
  /// Complete intervals (LiveEnd completes the last), oldest first; each is returned once. At most
  /// the last 4096 are kept.
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
