/// @file
/// One continuous clock for everything that a receiver gets: from one sender, from the next one,
/// and from a sender whose timestamps jump.
///
///     SessionClock clock;
///     clock.push(*source->next(0.1), seconds, events);   // events: times that can be trusted
///
/// Timestamps of units are only claims, and filling gaps (text with every frame, silence) costs
/// memory in proportion. So a gap is accepted as far as time has passed at the receiver, and a
/// little further; units without gaps, each where the one before it ends, may arrive faster (a file
/// sent without pacing), up to an hour ahead. A jump in time must be confirmed by two more units
/// that follow it. Then, or after a LiveRestart, time
/// continues by the arrival of packets, after what was already delivered. Times ascend in each
/// track.
///
///     auto source = make_steady(open_source("talk.sdp"));   // the same as a source
///
/// Source: tools/formats/media/live/receiving.md, section 2.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Uses neither sources nor clocks: the caller passes the time.
class SessionClock {
 public:
  /// Takes an event that arrived at `now`, seconds of any steady clock, and appends the resulting
  /// events to `out`. Times of the first sender are unchanged. LiveRestart becomes a LiveGap of
  /// both tracks. The first LiveInfo determines the time scale of the face; if the sound of a later
  /// sender differs only in its priming, it gets that of the first.
  void push(LiveEvent event, double now, std::deque<LiveEvent>& out);

  std::int64_t sessions() const { return sessions_; }  ///< senders, counting restarts; 0: none yet
  /// Units that were dropped because their time was not confirmed or not ascending.
  std::int64_t refused() const { return refused_; }

 private:
  struct Held {
    LiveUnit unit;
    double time = 0;  // seconds of its sender
    double arrival = 0;
  };
  struct Track {
    double shift = 0;                  // seconds, from the sender's time to ours
    std::optional<std::int64_t> last;  // ours, ticks
    double last_arrival = 0;
    std::vector<Held> candidates;
  };

  Track& of(LiveTrack track) { return tracks_[std::size_t(track)]; }
  void take_info(LiveInfo info, std::deque<LiveEvent>& out);
  void take_unit(LiveUnit unit, double now, std::deque<LiveEvent>& out);
  double rate(LiveTrack track, const LiveInfo& info) const;
  double horizon(double now) const { return anchor_ + (now - anchor_at_); }
  void begin(const Held& first);
  bool give(Held& held, std::deque<LiveEvent>& out);
  void consider(Held held, double ahead, std::deque<LiveEvent>& out);
  void believe(LiveTrack name, std::deque<LiveEvent>& out);
  void release(LiveTrack name, std::deque<LiveEvent>& out);

  std::optional<LiveInfo> given_;      // that the receiver has
  LiveInfo sender_;                    // from the current sender
  Track tracks_[2];                    // by LiveTrack
  double anchor_ = 0, anchor_at_ = 0;  // our time, when
  double began_ = 0, began_at_ = 0;    // the first anchor
  double jumped_at_ = -1e9;            // arrival of what was believed last
  double reached_ = 0;                 // our time at which the last unit of either track ends
  double slack_ = 0;                   // seconds that the next one may begin later
  double spare_ = 0;                   // seconds that gaps may be longer than time has passed
  double spare_at_ = 0;
  bool begun_ = false, restarting_ = false;
  std::int64_t sessions_ = 0, refused_ = 0;
};

/// `source` on such a clock; its arrival is the moment when next() has something.
std::unique_ptr<LiveSource> make_steady(std::unique_ptr<LiveSource> source);

}  // namespace animeme::media
