#include "tools/formats/media/rtp/rtp_timeline.h"

#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr double kTolerance = 0.02;
constexpr double kMostDelay = 10;  // of one track behind the other, seconds
constexpr int kAgreeing = 3;       // reports
// Priming and planes before time 0; more is a clock that has wrapped.
constexpr std::uint32_t kSecondsBeforeZero = 60;

}  // namespace

RtpTimeline::RtpTimeline(std::uint32_t face_clock, std::uint32_t audio_clock, double patience)
    : patience_(patience) {
  of(LiveTrack::face).clock = face_clock;
  of(LiveTrack::audio).clock = audio_clock;
}

bool RtpTimeline::all(bool (*test)(const Track&)) const {
  for (const Track& track : tracks_) {
    if (track.clock != 0 && !test(track)) return false;
  }
  return true;
}

void RtpTimeline::take_report(Track& track, const SenderInfo& report) {
  track.ntp = report.ntp;
  track.reported = track.last + std::int32_t(report.rtp - std::uint32_t(track.last));
}

std::int64_t RtpTimeline::add(LiveTrack which, std::uint32_t timestamp, double now) {
  Track& track = of(which);
  track.last = track.unwrapper.add(timestamp);
  if (!track.heard) {
    track.heard = true;
    track.first = track.last;
    track.first_arrival = now;
    if (track.raw_report) take_report(track, *std::exchange(track.raw_report, std::nullopt));
    if (sync_ != RtpSync::none) set_zero(track);
  }
  return track.last;
}

void RtpTimeline::add_report(LiveTrack which, const SenderInfo& report) {
  Track& track = of(which);
  if (report.ntp == 0) return;  // the sender has no clock
  if (!track.heard) {
    track.raw_report = report;
    return;
  }
  take_report(track, report);
  check_against_reports();
}

void RtpTimeline::describe(LiveTrack track, std::optional<std::uint32_t> offset) {
  of(track).offset = offset;
}

void RtpTimeline::restart() {
  for (Track& track : tracks_) track = Track{.clock = track.clock, .unwrapper = {}};
  sync_ = RtpSync::none;
  proposals_ = 0;
}

// From a track that has a zero to one that has none: the same instant on the sender's clock.
std::int64_t RtpTimeline::zero_by_reports(const Track& track, const Track& other) const {
  constexpr double kNtpSecond = 4294967296.0;
  const double between = double(std::int64_t(*track.ntp - *other.ntp)) / kNtpSecond;
  const double since_zero = double(other.reported - *other.zero) / other.clock;
  return track.reported - std::llround((between + since_zero) * track.clock);
}

std::int64_t RtpTimeline::zero_by_arrival(const Track& track, const Track& other) {
  const double later = track.first_arrival - other.first_arrival;
  const double other_time = double(other.first - *other.zero) / other.clock;
  return track.first - std::llround((other_time + later) * track.clock);
}

void RtpTimeline::set_zero(Track& track) {
  if (track.offset) {
    std::int64_t since = std::uint32_t(std::uint32_t(track.first) - *track.offset);
    const std::int64_t before = std::int64_t(kSecondsBeforeZero) * track.clock;
    constexpr std::int64_t kWrap = std::int64_t(1) << 32;
    if (since >= kWrap - before) since -= kWrap;
    track.zero = track.first - since;
    return;
  }
  const Track& other = tracks_[&track == &tracks_[0] ? 1 : 0];
  if (!other.zero) {
    track.zero = track.first;
    return;
  }
  if (track.ntp && other.ntp) {
    const std::int64_t zero = zero_by_reports(track, other);
    if (is_credible(track, other, zero)) {
      track.zero = zero;
      return;
    }
  }
  track.zero = zero_by_arrival(track, other);
}

bool RtpTimeline::is_credible(const Track& track, const Track& other, std::int64_t zero) const {
  return std::abs(double(zero - zero_by_arrival(track, other))) <= kMostDelay * track.clock;
}

bool RtpTimeline::settle(double now) {
  if (sync_ != RtpSync::none) return true;
  const bool described = all([](const Track& track) { return track.offset.has_value(); });
  // With all of them heard, so that time 0 is a plane.
  const bool reported = all([](const Track& track) { return track.ntp.has_value(); });
  const bool single = tracks_[0].clock == 0 || tracks_[1].clock == 0;
  const std::optional<double> end = deadline();
  if (!end || (!described && !reported && !single && *end > now)) return false;
  const bool tied = all([](const Track& track) { return track.ntp || track.raw_report; });
  sync_ = described ? RtpSync::description : tied ? RtpSync::reports : RtpSync::arrival;
  for (Track& track : tracks_) {
    if (!described) track.offset.reset();
    if (track.clock != 0 && track.heard) set_zero(track);
  }
  return true;
}

std::optional<double> RtpTimeline::deadline() const {
  std::optional<double> begin;
  for (const Track& track : tracks_) {
    if (track.heard && (!begin || track.first_arrival < *begin)) begin = track.first_arrival;
  }
  if (begin) *begin += patience_;
  return sync_ == RtpSync::none ? begin : std::nullopt;
}

void RtpTimeline::check_against_reports() {
  const Track& face = of(LiveTrack::face);
  Track& audio = of(LiveTrack::audio);
  if (!face.zero || !audio.zero || !face.ntp || !audio.ntp) return;
  const std::int64_t zero = zero_by_reports(audio, face);
  if (!is_credible(audio, face, zero)) return;
  const auto near = [&](std::int64_t other) {
    return std::abs(double(zero - other)) <= kTolerance * audio.clock;
  };
  if (sync_ != RtpSync::arrival) {
    proposals_ = near(*audio.zero) ? 0 : proposals_ > 0 && near(proposed_) ? proposals_ + 1 : 1;
    proposed_ = zero;
    if (proposals_ < kAgreeing) return;
  }
  proposals_ = 0;
  audio.zero = zero;
  if (sync_ == RtpSync::arrival) sync_ = RtpSync::reports;
}

std::int64_t RtpTimeline::time(LiveTrack which, std::int64_t unwrapped) {
  Track& track = of(which);
  if (!track.zero) set_zero(track);
  return unwrapped - *track.zero;
}

}  // namespace animeme::media
