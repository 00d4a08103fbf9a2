// From PES packets to what a LiveSource gives out: times, units, the description in front.
// Source: tools/formats/media/containers.md, sections 3.2 and 4.2.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tools/formats/media/detail/tracks/plane_cutter.h"
#include "tools/formats/media/detail/ts/ts_demuxer.h"
#include "tools/formats/media/detail/ts/ts_sound.h"

namespace animeme::media {

class TsEvents {
 public:
  /// Appends what follows from `event` to `out`.
  void push(TsEvent event, std::deque<LiveEvent>& out);
  /// Nothing will come any more: gives out what was held back, and LiveEnd.
  void finish(std::deque<LiveEvent>& out);

 private:
  void take_map(const TsProgram& program);
  void take_face(TsPes& pes);
  void take_sound(TsPes& pes);
  void hold(LiveUnit unit, std::int64_t stamp);
  bool outage(const TsPes& pes, std::int64_t stamp, std::int64_t interval) const;
  void gap(LiveTrack track, std::int64_t packets);
  void deliver(bool whatever_is_known, std::deque<LiveEvent>& out);
  bool known(LiveTrack track) const;
  LiveInfo describe() const;
  std::optional<std::int64_t> unwrap(const TsPes& pes);

  struct Clock {
    std::int64_t last = 0;      // time of the last unit
    std::int64_t interval = 0;  // to the one before it; 0: not known
    bool started = false;
    std::optional<std::int64_t> stamp;  // of the last unit that had one, unwrapped
  };

  TsProgram program_;
  std::vector<std::uint8_t> config_;  // of the face
  PlaneCutter cutter_;
  bool film_ = false;  // stream type 0x10, but no face
  TsSound sound_;
  int priming_ = 0;
  Clock clocks_[2];                         // by LiveTrack
  std::optional<std::int64_t> last_stamp_;  // unwrapped, of either track
  std::deque<LiveEvent> held_;
  std::size_t held_bytes_ = 0;
  std::int64_t held_from_ = 0, held_to_ = 0;  // stamps
  std::optional<LiveInfo> told_;
};

}  // namespace animeme::media
