/// @file
/// One clock for all that a receiver hears: of a sender, of the one that comes after it, and of
/// whoever says something else about the time than its packets before.
///
///     SessionClock clock;
///     clock.push(*source->next(0.1), seconds, events);   // events: times that can be trusted
///
/// Times of units are claims. What fills gaps (text with every frame, silence) costs what they
/// claim, so a gap is believed as far as time has passed at the receiver, and a little further; so
/// much data as there is may come faster (a file sent without waiting). A unit elsewhere in time
/// has to be confirmed by two more that follow it. Then, or behind a LiveRestart, time goes on by
/// the arrival of packets, behind what was given out before. Each track ascends.
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

/// Knows neither sources nor clocks: the caller says what time it is.
class SessionClock {
 public:
  /// Takes an event that came at `now`, seconds of any steady clock, and appends to `out` what
  /// follows from it. Times of the first sender stay as they are. LiveRestart becomes a LiveGap of
  /// both tracks. The first LiveInfo decides on the time scale of the face; a sound of later
  /// senders that differs in its priming only has that of the first.
  void push(LiveEvent event, double now, std::deque<LiveEvent>& out);

  std::int64_t sessions() const { return sessions_; }  ///< senders, or begins of one; 0: none yet
  /// Units that were left out, as their time was not confirmed or before that of others.
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

  std::optional<LiveInfo> given_;      // told to the receiver
  LiveInfo sender_;                    // what the sender in force has said
  Track tracks_[2];                    // by LiveTrack
  double anchor_ = 0, anchor_at_ = 0;  // our time, when
  double reached_ = 0;                 // our time of the last unit of either track
  double spare_ = 0;                   // seconds that gaps may be longer than time has passed
  double spare_at_ = 0;
  bool begun_ = false, restarting_ = false;
  std::int64_t sessions_ = 0, refused_ = 0;
};

/// `source` on such a clock; its arrival is the moment when next() has something.
std::unique_ptr<LiveSource> make_steady(std::unique_ptr<LiveSource> source);

}  // namespace animeme::media
