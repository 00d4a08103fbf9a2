#include "tools/formats/media/rtp/rtp_receiver.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMaxWaiting = 8 << 20;
constexpr std::size_t kItemCost = 256;  // of a queue entry beside its bytes
constexpr double kOtherSilent = 1;      // after a goodbye of one track the other one has gone, too

std::size_t cost(const LiveEvent& event) {
  const LiveUnit* unit = std::get_if<LiveUnit>(&event);
  return kItemCost + (unit != nullptr ? unit->bytes.size() : 0);
}

}  // namespace

RtpReceiver::RtpReceiver(const RtpSession& session, const RtpReceiveOptions& options,
                         std::uint32_t id)
    : session_(session),
      options_(options),
      id_(id),
      dice_(id | 1),
      timeline_(session.face ? kFaceClock : 0, session.audio ? session.audio->clock : 0,
                options.sync_seconds),
      timescale_(session.face && session.face->timescale > 0 ? session.face->timescale
                                                             : kFaceClock) {
  RtpInput::Settings settings;
  settings.limits.seconds = options.reorder_seconds;
  settings.limits.most_seconds = options.reorder_most_seconds;
  settings.limits.packets = std::size_t(options.reorder_packets);
  settings.any_source = options.any_source;
  const auto add = [&](LiveTrack track, const RtpTrack& described) {
    settings.payload_type = described.payload_type;
    settings.clock = track == LiveTrack::face ? kFaceClock : described.clock;
    settings.bundle_id = track == LiveTrack::face ? session.face->bundle_id : 0;
    settings.ssrc = described.ssrc;
    settings.face = track == LiveTrack::face;
    sources_.push_back({track, RtpInput(settings)});
  };
  if (session.face) {
    face_.emplace(session.face->config, timescale_);
    add(LiveTrack::face, *session.face);
  }
  if (session.audio) {
    audio_.emplace(*session.audio);
    add(LiveTrack::audio, *session.audio);
  }
}

RtpReceiver::Source* RtpReceiver::source(LiveTrack track) {
  for (Source& each : sources_) {
    if (each.track == track) return &each;
  }
  return nullptr;
}

const RtpReceiver::Source* RtpReceiver::source(LiveTrack track) const {
  for (const Source& each : sources_) {
    if (each.track == track) return &each;
  }
  return nullptr;
}

std::vector<RtpInput::Early> RtpReceiver::early(LiveTrack track) const {
  const Source* const from = source(track);
  return from != nullptr ? from->input.early() : std::vector<RtpInput::Early>();
}

const RtpTrack& RtpReceiver::described(const Source& source) const {
  if (source.track == LiveTrack::face) return *session_.face;
  return *session_.audio;
}

// The clock in the description holds for the sender that wrote it. Once one track is known to come
// from there, the other one, not yet heard, is believed to.
void RtpReceiver::describe(const Source& source) {
  if (source.input.ssrc() != described(source).ssrc) {
    timeline_.describe(source.track, std::nullopt);
    return;
  }
  for (const Source& each : sources_) {
    const RtpTrack& track = described(each);
    const bool fits = !each.input.ssrc() || each.input.ssrc() == track.ssrc;
    timeline_.describe(each.track, fits ? track.clock_offset : std::nullopt);
  }
}

void RtpReceiver::rtp(LiveTrack track, std::span<const std::uint8_t> datagram,
                      const UdpAddress& from, double now) {
  Source* const to = source(track);
  if (to == nullptr) return;
  if (looks_like_rtcp(datagram)) {
    rtcp(track, datagram, from, now);
    return;
  }
  const RtpInput::Taken taken = to->input.add(datagram, from, now);
  if (taken == RtpInput::Taken::no) return;
  if (taken == RtpInput::Taken::restart) restart(now);
  if (!to->begun) {
    describe(*to);
    if (const auto report = to->input.take_report()) timeline_.add_report(track, *report);
  }
  to->begun = true;
  sessions_ = std::max<std::int64_t>(1, sessions_);
}

bool RtpReceiver::hears(LiveTrack track, std::span<const std::uint8_t> datagram,
                        const UdpAddress& from) const {
  const Source* const at = source(track);
  return at != nullptr && (looks_like_rtcp(datagram) || at->input.hears(datagram, from));
}

bool RtpReceiver::rtcp(LiveTrack track, std::span<const std::uint8_t> datagram,
                       const UdpAddress& from, double now) {
  Source* const to = source(track);
  if (to == nullptr) return false;
  const std::optional<RtcpMessage> message = read_rtcp(datagram);
  if (!message) {
    to->input.ignore();
    return false;
  }
  bool ours = false;
  for (const RtcpReport& report : message->reports) {
    if (!to->input.add_report(report, from, now)) continue;
    timeline_.add_report(track, *report.sender);
    ours = true;
  }
  for (const std::uint32_t ssrc : message->byes) to->input.add_bye(ssrc, from, now);
  return ours;
}

void RtpReceiver::drain(Source& source, double now) {
  while (std::optional<ReorderBuffer::Item> item = source.input.next(now)) {
    const bool face = source.track == LiveTrack::face;
    if (const auto* missing = std::get_if<ReorderBuffer::Missing>(&*item)) {
      face ? face_->gap() : audio_->gap();
      push(LiveGap{source.track, missing->packets});
      continue;
    }
    const RtpPacket& packet = std::get<RtpPacket>(*item);
    const std::int64_t time = timeline_.add(source.track, packet.timestamp, now);
    add_units(source, face ? face_->add(packet, time) : audio_->add(packet, time));
  }
}

void RtpReceiver::add_units(Source& source, RtpUnits units) {
  if (units.damaged) push(LiveGap{source.track, 0});
  if (source.track == LiveTrack::face && face_->config() != session_.face->config) {
    session_.face->config = face_->config();
    if (announced_) push(info());
  }
  for (LiveUnit& unit : units.units) push(std::move(unit));
}

void RtpReceiver::push(LiveEvent event) {
  ended_ = false;
  if (waiting_bytes_ + cost(event) > kMaxWaiting) {
    overflowed_ = true;
    return;
  }
  if (overflowed_) {
    overflowed_ = false;
    for (const Source& each : sources_) push(LiveGap{each.track, 0});
  }
  waiting_bytes_ += cost(event);
  const LiveGap* gap = std::get_if<LiveGap>(&event);
  if (gap != nullptr && gap->track == LiveTrack::face) wants_intra_ = true;
  const LiveUnit* unit = std::get_if<LiveUnit>(&event);
  if (unit != nullptr && unit->track == LiveTrack::face && unit->intra) wants_intra_ = false;
  pending_.push_back(std::move(event));
}

LiveEvent RtpReceiver::pop(std::deque<LiveEvent>& queue) {
  LiveEvent event = std::move(queue.front());
  queue.pop_front();
  waiting_bytes_ -= cost(event);
  return event;
}

void RtpReceiver::flush(double now) {
  for (Source& each : sources_) {
    each.input.flush();
    drain(each, now);
  }
  timeline_.settle(std::numeric_limits<double>::infinity());
}

// The old sender's units get their times while its clock is known.
void RtpReceiver::restart(double now) {
  flush(now);
  if (!announced_ && !pending_.empty()) {
    ready_.push_back(info());
    waiting_bytes_ += cost(ready_.back());
  }
  for (LiveEvent& event : pending_) {
    if (LiveUnit* unit = std::get_if<LiveUnit>(&event)) *unit = timed(std::move(*unit));
    ready_.push_back(std::move(event));
  }
  pending_.clear();
  ready_.push_back(LiveRestart{});
  waiting_bytes_ += cost(ready_.back());
  timeline_.restart();
  if (face_) face_->restart();
  if (audio_) audio_->gap();
  for (Source& each : sources_) {
    each.input.accept();
    each.begun = false;
  }
  announced_ = ended_ = false;
  ++sessions_;
}

LiveUnit RtpReceiver::timed(LiveUnit unit) {
  unit.time = timeline_.time(unit.track, unit.time);
  if (unit.track == LiveTrack::face) {
    unit.time = to_timescale(unit.time, timescale_, face_->rate());
  }
  return unit;
}

LiveInfo RtpReceiver::info() const {
  LiveInfo info;
  info.timescale = timescale_;
  if (session_.face) {
    info.face_config = face_->config();
    const std::uint8_t profile = read_visual_headers(info.face_config).profile;
    info.visual_profile = profile != 0 ? profile : session_.face->visual_profile;
  }
  if (session_.audio) info.audio = session_.audio->format;
  return info;
}

std::optional<LiveEvent> RtpReceiver::next(double now) {
  for (Source& source : sources_) drain(source, now);
  if (!ready_.empty()) return pop(ready_);
  if (!pending_.empty() && timeline_.settle(now)) {
    if (!std::exchange(announced_, true)) return info();
    LiveEvent event = pop(pending_);
    if (LiveUnit* unit = std::get_if<LiveUnit>(&event)) *unit = timed(std::move(*unit));
    return event;
  }
  const std::optional<double> end = end_time();
  if (ended_ || !pending_.empty() || !end || *end > now) return std::nullopt;
  ended_ = true;
  return LiveEnd{};
}

// Packets may still be on their way when the goodbye is here.
std::optional<double> RtpReceiver::end_time() const {
  std::optional<double> end;
  for (const Source& each : sources_) {
    if (each.input.bye_at()) end = std::max(end.value_or(0), *each.input.bye_at());
  }
  if (!end) return std::nullopt;
  *end += options_.reorder_seconds;
  for (const Source& each : sources_) {
    if (each.begun && !each.input.bye_at()) {
      end = std::max(*end, each.input.last_heard() + kOtherSilent);
    }
  }
  return end;
}

std::optional<double> RtpReceiver::deadline() const {
  std::optional<double> first;
  const auto consider = [&first](std::optional<double> when) {
    if (when && (!first || *when < *first)) first = when;
  };
  for (const Source& each : sources_) consider(each.input.deadline());
  if (!ready_.empty() || !pending_.empty()) consider(timeline_.deadline().value_or(0));
  if (!ended_) consider(end_time());
  return first;
}

}  // namespace animeme::media
