/// @file
/// Units as they come, on the clock of a file.
///
/// Time 0 of a file is where the first of both tracks begins: the first plane, or the first sample
/// that can be heard (behind the priming of the first packet). A presentation that was received
/// from its begin on has the times of its sender. Where time 0 lies between two ticks of the other
/// track, that is rounded to the nearest one, all of it alike.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Knows each unit's time once both tracks have begun or one of them has lasted for a second, and a
/// plane's duration once the next one is there, or the sound is a second further. Not thread safe.
class RecordedTimes {
 public:
  /// `unit`: its times ascend in its track, its duration is positive. `info`: of the presentation;
  /// of the sound the first one counts that is there when time 0 is decided on.
  void push(const LiveInfo& info, LiveUnit unit);
  /// Nothing comes any more: what was held is certain now.
  void finish(const LiveInfo& info);
  /// What is certain. The first plane begins with the object start code. Units before time 0 of a
  /// track that came too late are left out.
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
