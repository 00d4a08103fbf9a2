/// @file
/// Maps the times of received units to the clock of a file.
///
/// Time 0 of a file is where the earlier of the tracks begins: the first plane, or the first
/// audible sample (after the priming of the first packet). A presentation received from its
/// beginning keeps the times of its sender. If time 0 lies between two ticks of the other track,
/// all of its times are shifted to the nearest tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Knows a unit's time once both tracks have begun or one of them has lasted for a second, and a
/// plane's duration once the next one has arrived or the sound is a second ahead. Not thread safe.
class RecordedTimes {
 public:
  /// `unit`: its times ascend in its track, its duration is positive. `info`: of the presentation;
  /// for the sound, the one known when time 0 is determined counts.
  void push(const LiveInfo& info, LiveUnit unit);
  /// Nothing more will come; releases what was held.
  void finish(const LiveInfo& info);
  /// The units with known times. The first plane begins with the object start code. Units before
  /// time 0 of a track that arrived too late are dropped.
  std::vector<LiveUnit> take();

 private:
  void settle(const LiveInfo& info);
  void place(const LiveInfo& info, LiveUnit unit);
  void give_plane();

  std::vector<LiveUnit> held_;  // time 0 is not known
  std::optional<LiveUnit> first_[2];
  bool settled_ = false;
  std::int64_t zero_[2] = {0, 0};  // by LiveTrack
  std::int64_t priming_ = 0;
  std::optional<LiveUnit> plane_;  // its duration is not known
  bool begun_ = false;             // a plane was given out, or waits as `plane_`
  bool given_ = false;             // a plane was given out
  std::vector<LiveUnit> ready_;
};

}  // namespace animeme::media
