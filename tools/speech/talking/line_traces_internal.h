// When of each line came out what.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>

#include "tools/formats/media/live/live.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::speech {

/// Fills the instants of lines in as their units are made and sent.
class LineTraces {
 public:
  /// Where the first signs of a line are, face in ticks, sound in samples.
  struct Signs {
    std::int64_t face = 0, sound = 0;
  };

  void add(const LineTrace& trace, const Signs& signs) {
    traces_.push_back(trace);
    signs_.push_back(signs);
    if (traces_.size() <= kMostTraces) return;
    traces_.pop_front();
    signs_.pop_front();
  }
  /// A unit was coded from instant `begun` to `coded`.
  void coded(const media::LiveUnit& unit, double begun, double coded) {
    each([&](LineTrace& trace, const Signs& sign) {
      if (unit.track == media::LiveTrack::face) {
        if (unit.time != sign.face) return;
        trace.face_begun = begun;
        trace.face_coded = coded;
      } else {
        if (unit.time + unit.duration <= sign.sound || trace.sound_coded != 0) return;
        trace.sound_begun = begun;
        trace.sound_coded = coded;
      }
    });
  }
  void sent(const media::LiveUnit& unit, double instant) {
    each([&](LineTrace& trace, const Signs& sign) {
      if (unit.track == media::LiveTrack::face) {
        if (unit.time == sign.face && trace.face_coded > 0) trace.face_sent = instant;
      } else if (trace.sound_coded > 0 && trace.sound_sent == 0 &&
                 unit.time + unit.duration > sign.sound) {
        trace.sound_sent = instant;
      }
    });
  }
  /// Signs that were not coded so far will never come.
  void stop() {
    each([](const LineTrace& trace, Signs& sign) {
      if (trace.face_coded == 0) sign.face = -1;
      if (trace.sound_coded == 0) sign.sound = std::numeric_limits<std::int64_t>::max();
    });
  }
  const std::deque<LineTrace>& all() const { return traces_; }

 private:
  static constexpr std::size_t kMostTraces = 1000;
  static constexpr std::size_t kMostOpen = 20;  // short pieces begin before the last one is heard

  // Of the lines whose signs may still come.
  template <class Look>
  void each(Look look) {
    const std::size_t count = std::min<std::size_t>(traces_.size(), kMostOpen);
    for (std::size_t i = traces_.size() - count; i < traces_.size(); ++i)
      look(traces_[i], signs_[i]);
  }

  std::deque<LineTrace> traces_;
  std::deque<Signs> signs_;  // of the traces
};

}  // namespace animeme::speech
