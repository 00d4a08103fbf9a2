#include "tools/formats/media/rtp/session_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/live/audio_segments.h"
#include "tools/formats/media/live/pacer.h"

namespace animeme::media {
namespace {

// What a unit lasts is data, not a gap, up to planes of four frames a second. The next one may
// begin as much later again, as stamps are rounded and cameras tremble.
constexpr double kDataStep = 0.25;
// Data may come faster than time passes, as of a file that is sent without pacing, but no further:
// a tiny unit may claim to last long.
constexpr double kMostLead = 3600;
constexpr double kMostSpare = 5;  // beyond the arrival clock, which a net may disturb
// A track that begins later may begin earlier in time: priming, what a server keeps for newcomers.
constexpr double kBefore = 10;
constexpr double kLate = 1;            // so far back a unit is late, not elsewhere
constexpr double kApart = 1;           // units that confirm each other
constexpr std::size_t kConfirmed = 3;  // units
constexpr double kJumpsApart = 1;      // seconds of arrival
constexpr double kLongestUnit = 10;    // duration
constexpr double kCorrection = 10;     // of one track by reports of its sender
constexpr double kCentury = 3e9;       // a time beyond is none

bool same_but_priming(AudioFormat a, AudioFormat b) {
  set_priming(a, 0);
  set_priming(b, 0);
  return a == b;
}

}  // namespace

double SessionClock::rate(LiveTrack track, const LiveInfo& info) const {
  if (track == LiveTrack::face) return std::max(1U, info.timescale);
  const std::optional<AudioFormat>& audio = info.audio ? info.audio : given_->audio;
  return audio ? std::max(1, audio->sample_rate) : 1;
}

void SessionClock::push(LiveEvent event, double now, std::deque<LiveEvent>& out) {
  if (auto* info = std::get_if<LiveInfo>(&event)) {
    take_info(std::move(*info), out);
  } else if (auto* unit = std::get_if<LiveUnit>(&event)) {
    if (given_) take_unit(std::move(*unit), now, out);
  } else if (std::holds_alternative<LiveRestart>(event)) {
    if (!begun_ || restarting_) return;
    restarting_ = true;
    for (Track& track : tracks_) track.candidates.clear();
    out.emplace_back(LiveGap{LiveTrack::face, 0});
    out.emplace_back(LiveGap{LiveTrack::audio, 0});
  } else {
    out.push_back(std::move(event));
  }
}

void SessionClock::take_info(LiveInfo info, std::deque<LiveEvent>& out) {
  sender_ = info;
  if (given_) {
    info.timescale = given_->timescale;
    const bool silent = !info.audio && of(LiveTrack::audio).last;
    if (silent || (info.audio && given_->audio && same_but_priming(*info.audio, *given_->audio))) {
      info.audio = given_->audio;
    }
    if (info == *given_) return;
  }
  given_ = info;
  out.emplace_back(std::move(info));
}

void SessionClock::begin(const Held& first) {
  if (!begun_ && std::abs(first.time) < kCentury) {
    anchor_ = first.time;  // the times of the sender
    spare_ = kMostSpare;
    spare_at_ = first.arrival;
  } else {
    anchor_ = begun_ ? std::max(horizon(first.arrival), reached_) : 0;
  }
  if (!begun_) {
    reached_ = began_ = anchor_;
    slack_ = 0;
    began_at_ = first.arrival;
  }
  anchor_at_ = first.arrival;
  const double shift = anchor_ == first.time ? 0 : anchor_ - first.time;
  for (Track& track : tracks_) track.shift = shift;
  begun_ = true;
  restarting_ = false;
  ++sessions_;
}

/// False: its time is not to be believed; `held` is as before.
bool SessionClock::give(Held& held, std::deque<LiveEvent>& out) {
  const LiveTrack name = held.unit.track;
  Track& track = of(name);
  const double ours = held.time + track.shift;
  if (!(std::abs(ours) < kCentury)) return false;
  const double from = rate(name, sender_), to = rate(name, *given_);
  std::int64_t ticks = held.unit.time;
  if (from != to) {
    ticks = std::llround(ours * to);
  } else if (track.shift != 0) {
    ticks += std::llround(track.shift * to);
  }
  if (track.last ? ticks <= *track.last : ours < anchor_ - kBefore) return false;
  spare_ = std::min(kMostSpare, spare_ + std::max(0.0, held.arrival - spare_at_));
  spare_at_ = std::max(spare_at_, held.arrival);
  if (ours - began_ > held.arrival - began_at_ + kMostLead) return false;
  const double ahead = ours - std::max(horizon(held.arrival), reached_ + slack_);
  if (ahead > spare_) return false;
  spare_ -= std::max(0.0, ahead);
  track.last = ticks;
  track.last_arrival = held.arrival;
  LiveUnit unit = std::move(held.unit);
  unit.time = ticks;
  const double duration = std::clamp(double(unit.duration) / from, 0.0, kLongestUnit);
  slack_ = std::min(duration, kDataStep / 2);
  reached_ = std::max(reached_, ours + std::min(duration, kDataStep));
  if (from != to || double(unit.duration) > kLongestUnit * from) {
    unit.duration = std::llround(duration * to);
  }
  out.emplace_back(std::move(unit));
  return true;
}

void SessionClock::take_unit(LiveUnit unit, double now, std::deque<LiveEvent>& out) {
  const LiveTrack name = unit.track;
  Held held{std::move(unit), 0, now};
  held.time = double(held.unit.time) / rate(name, sender_);
  if (!begun_ || restarting_) begin(held);
  if (give(held, out)) {
    refused_ += std::int64_t(of(name).candidates.size());
    of(name).candidates.clear();
    return;
  }
  const Track& track = of(name);
  const double last = track.last ? double(*track.last) / rate(name, *given_) : anchor_;
  consider(std::move(held), held.time + track.shift - last, out);
}

/// `ahead`: seconds behind the last unit of the track.
void SessionClock::consider(Held held, double ahead, std::deque<LiveEvent>& out) {
  const LiveTrack name = held.unit.track;
  Track& track = of(name);
  if (ahead <= 0 && ahead > -kLate && track.last) {
    ++refused_;
    return;
  }
  if (!track.candidates.empty()) {
    const Held& before = track.candidates.back();
    const double step = held.time - before.time;
    if (step <= 0 || step > held.arrival - before.arrival + kApart) {
      refused_ += std::int64_t(track.candidates.size());
      track.candidates.clear();
    }
  }
  track.candidates.push_back(std::move(held));
  if (track.candidates.size() < kConfirmed) return;
  // A track whose sender has set its clock back a little, while the other one goes on, goes on
  // when that time is reached: what was given out is ahead of the other one by so much.
  const Track& other = tracks_[1 - std::size_t(name)];
  const bool alone = other.last && other.last_arrival >= track.candidates.front().arrival;
  if (alone && ahead <= 0 && ahead > -kCorrection) {
    ++refused_;
    track.candidates.erase(track.candidates.begin());
    return;
  }
  believe(name, out);
}

void SessionClock::believe(LiveTrack name, std::deque<LiveEvent>& out) {
  Track& track = of(name);
  Track& other = tracks_[1 - std::size_t(name)];
  const Held first = track.candidates.front();
  const double by_other = first.time + other.shift;
  const double last = track.last ? double(*track.last) / rate(name, *given_) : by_other - 1;
  const bool fits = other.shift != track.shift && by_other > last &&
                    std::abs(by_other - horizon(first.arrival)) < kApart;
  // Each jump claims a little: whoever jumps without end should not run ahead by that.
  if (!fits && first.arrival < jumped_at_ + kJumpsApart) {
    ++refused_;
    track.candidates.erase(track.candidates.begin());
    return;
  }
  const double kept = other.shift;
  const bool other_goes_on = other.last && other.last_arrival >= first.arrival;
  if (fits) {
    track.shift = kept;
  } else {
    begin(first);
    jumped_at_ = first.arrival;
    if (other_goes_on) other.shift = kept;
  }
  release(name, out);
  if (!fits && !other_goes_on) release(LiveTrack(1 - int(name)), out);
}

/// Units that were held back, with the time that is believed now.
void SessionClock::release(LiveTrack name, std::deque<LiveEvent>& out) {
  std::vector<Held> held = std::exchange(of(name).candidates, {});
  out.emplace_back(LiveGap{name, 0});
  for (Held& each : held) refused_ += give(each, out) ? 0 : 1;
}

namespace {

class SteadySource : public LiveSource {
 public:
  explicit SteadySource(std::unique_ptr<LiveSource> source) : source_(std::move(source)) {}

  Result<LiveEvent> next(double seconds) override {
    Clock& clock = steady_clock();
    const double end = clock.now() + std::max(0.0, seconds);
    while (events_.empty()) {
      const double now = clock.now();
      Result<LiveEvent> event = source_->next(std::max(0.0, end - now));
      if (!event || std::holds_alternative<LiveIdle>(*event)) return event;
      clock_.push(std::move(*event), clock.now(), events_);
      if (events_.empty() && clock.now() >= end) return LiveEvent(LiveIdle{});
    }
    Result<LiveEvent> event{LiveEvent(LiveIdle{})};
    std::swap(*event, events_.front());  // not moved: g++ 12 warns in vain
    events_.pop_front();
    return event;
  }

  ReceiveStats stats() const override {
    ReceiveStats stats = source_->stats();
    stats.sessions = clock_.sessions();
    stats.late += clock_.refused();
    return stats;
  }

 private:
  std::unique_ptr<LiveSource> source_;
  SessionClock clock_;
  std::deque<LiveEvent> events_;
};

}  // namespace

std::unique_ptr<LiveSource> make_steady(std::unique_ptr<LiveSource> source) {
  return std::make_unique<SteadySource>(std::move(source));
}

}  // namespace animeme::media
