#include "tools/formats/media/rtp/rtp_sender.h"
#include "tools/formats/media/detail/ffmpeg/invalid.h"

#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr double kPause = 0.2;      // seconds: a plane so late ends a wait for it
constexpr double kOftenUntil = 10;  // reports come each second at first, for quick lip sync,
constexpr double kReportOften = 1;  // then as RFC 3550 section 6.2 has it
constexpr double kReportSeldom = 5;
constexpr int kGoodbyes = 2;

// Numbers that follow from a seed (splitmix64).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::uint32_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return std::uint32_t((z ^ (z >> 31)) >> 32);
  }

 private:
  std::uint64_t state_;
};

// Ticks as NTP, 2^-32 s; floor.
std::uint64_t ntp_span(std::int64_t ticks, std::uint32_t clock) {
  std::int64_t seconds = ticks / clock;
  std::int64_t rest = ticks % clock;
  if (rest < 0) {
    rest += clock;
    --seconds;
  }
  return (std::uint64_t(seconds) << 32) + (std::uint64_t(rest) << 32) / clock;
}

}  // namespace

Result<void> check(const LiveInfo& info, const RtpOptions& options) {
  constexpr int kMaxAudioBundle = 32;
  if (options.mtu < 256 || options.mtu > 65000) return invalid("mtu must be 256..65000");
  if (options.repeat < 1 || options.repeat > 8) return invalid("repeat must be 1..8");
  if (options.repeat_after < 1 || options.repeat_after > 50) {
    return invalid("repeat_after must be 1..50");
  }
  if (options.bundle < 1 || options.bundle > int(kMaxBundle)) {
    return invalid("bundle must be 1..16");
  }
  if (options.audio_bundle < 1 || options.audio_bundle > kMaxAudioBundle) {
    return invalid("audio_bundle must be 1..32");
  }
  if (options.ttl < 0 || options.ttl > 255) return invalid("ttl must be 0..255");
  if (info.face_config.empty() && !info.audio) {
    return invalid("a presentation needs a face, with its configuration, or a sound");
  }
  if (info.timescale == 0 || info.timescale > kMaxTimescale) {
    return invalid("the time scale of the face must be 1..10000000");
  }
  if (info.audio && info.audio->sample_rate <= 0) return invalid("the sound has no sample rate");
  return {};
}

RtpSender::RtpSender(const LiveInfo& info, const RtpOptions& options, const std::string& address,
                     int port, std::uint64_t seed, std::uint64_t ntp)
    : info_(info), options_(options), ntp_(ntp) {
  Dice dice(seed);
  const auto identity = [&dice] {
    return RtpIdentity{dice.next(), dice.next(), std::uint16_t(dice.next())};
  };
  const auto describe = [&](RtpTrack& track, int at_port) {
    track.address = address;
    track.port = at_port;
    track.rtcp_port = at_port + 1;
    track.ttl = options.ttl;
  };
  session_.name = options.name;
  // Nobody else should have it, RFC 7022.
  session_.cname = "animeme-" + std::to_string(seed);
  if (!info.face_config.empty()) {
    RtpFaceTrack& face = session_.face.emplace();
    describe(face, port);
    face.config = info.face_config;
    face.visual_profile = info.visual_profile;
    face.timescale = info.timescale;
    if (options.bundle > 1) face.bundle_id = kBundleExtensionId;
    add_track(LiveTrack::face, face, identity());
  }
  if (info.audio) {
    RtpAudioTrack& audio = session_.audio.emplace();
    describe(audio, port + 2);
    audio.format = *info.audio;
    RtpIdentity other = identity();
    if (!tracks_.empty() && tracks_.front().packets.ssrc() == other.ssrc) ++other.ssrc;
    add_track(LiveTrack::audio, audio, other);
  }
}

void RtpSender::add_track(LiveTrack track, RtpTrack& described, const RtpIdentity& identity) {
  described.payload_type = track == LiveTrack::face ? 96 : 97;
  described.ssrc = identity.ssrc;
  described.clock_offset = identity.offset;
  tracks_.push_back(
      {RtpPacketizer(track, info_, options_, identity, std::uint8_t(described.payload_type))});
  described.clock = tracks_.back().packets.clock();
}

RtpSender::Track* RtpSender::find(LiveTrack track) {
  for (Track& each : tracks_) {
    if (each.packets.track() == track) return &each;
  }
  return nullptr;
}

Result<void> RtpSender::send(const LiveUnit& unit, double now, Datagrams& out) {
  Track* const track = find(unit.track);
  const bool face = unit.track == LiveTrack::face;
  if (track == nullptr) {
    return invalid(face ? "the presentation has no face" : "the presentation has no sound");
  }
  RtpPacketizer& packets = track->packets;
  if (auto ok = packets.check(unit); !ok) return ok;
  if (!zero_) {
    zero_ = now - packets.seconds(unit.time);
    for (Track& each : tracks_) report(each, now, false, out);
  }
  if (!packets.fits(unit)) flush(*track, now, out);
  if (packets.empty()) {
    track->gather_until = now + packets.most() * packets.seconds(unit.duration) + kPause;
  }
  ++(face ? stats_.face_units : stats_.audio_units);
  packets.add(unit);
  if (packets.full()) flush(*track, now, out);
  poll(now, out);
  return {};
}

void RtpSender::flush(Track& track, double now, Datagrams& out) {
  Datagrams packets;
  for (auto& bytes : track.packets.flush()) {
    packets.push_back({track.packets.track(), false, std::move(bytes)});
  }
  for (const RtpDatagram& packet : packets) emit(packet, out);
  if (track.packets.track() != LiveTrack::face || packets.empty()) return;
  last_plane_ = now;
  send_copies(false, out);
  for (const RtpDatagram& packet : packets) {
    for (int copy = 1; copy < options_.repeat; ++copy) {
      copies_.push_back({packet, copy * options_.repeat_after});
    }
  }
}

void RtpSender::emit(RtpDatagram datagram, Datagrams& out) {
  ++stats_.packets;
  stats_.bytes += std::int64_t(datagram.bytes.size());
  out.push_back(std::move(datagram));
}

// Copies come after the packets of a later plane; `all`: there is none to come.
void RtpSender::send_copies(bool all, Datagrams& out) {
  std::vector<Copy> later;
  for (Copy& copy : copies_) {
    if (--copy.after > 0 && !all) {
      later.push_back(std::move(copy));
      continue;
    }
    ++stats_.repeated;
    emit(std::move(copy.datagram), out);
  }
  copies_ = std::move(later);
}

void RtpSender::report(Track& track, double now, bool bye, Datagrams& out) {
  const std::int64_t since = std::llround((now - *zero_) * track.packets.clock());
  const std::int64_t zero = std::llround(*zero_ * 4294967296.0);
  SenderInfo info;
  info.ntp = ntp_ + std::uint64_t(zero) + ntp_span(since, track.packets.clock());
  info.rtp = std::uint32_t(track.packets.offset() + since);
  info.packets = track.packets.packets();
  info.octets = track.packets.octets();
  RtcpMessage message;
  message.reports.push_back({track.packets.ssrc(), info, {}});
  message.names.push_back({track.packets.ssrc(), session_.cname});
  if (bye) message.byes.push_back(track.packets.ssrc());
  emit({track.packets.track(), true, write_rtcp(message)}, out);
  const bool often = now - *zero_ < kOftenUntil;
  track.next_report = now + (often ? kReportOften : kReportSeldom);
}

void RtpSender::poll(double now, Datagrams& out) {
  if (!zero_) return;
  for (Track& track : tracks_) {
    if (!track.packets.empty() && now > track.gather_until) flush(track, now, out);
    if (now >= track.next_report) report(track, now, false, out);
  }
  if (now > last_plane_ + kPause) send_copies(true, out);
}

void RtpSender::finish(double now, Datagrams& out) {
  if (!zero_) return;
  for (Track& track : tracks_) flush(track, now, out);
  send_copies(true, out);
  for (int i = 0; i < kGoodbyes; ++i) {
    for (Track& track : tracks_) report(track, now, true, out);
  }
}

void RtpSender::rtcp(std::span<const std::uint8_t> datagram, double now) {
  const std::optional<RtcpMessage> message = read_rtcp(datagram);
  if (!message) return;
  for (const RtcpReport& report : message->reports) {
    for (const ReportBlock& block : report.blocks) {
      for (const Track& track : tracks_) {
        if (block.ssrc != track.packets.ssrc()) continue;
        listeners_.add(report.ssrc, track.packets.track(), block, now);
      }
    }
  }
  for (const std::uint32_t ssrc : message->byes) {
    listeners_.remove(ssrc);
    full_requests_.erase(ssrc);
  }
  const Track* face = find(LiveTrack::face);
  for (const IntraRequest& request : message->requests) {
    if (face == nullptr || request.media != face->packets.ssrc()) continue;
    if (request.sequence) {
      const auto last = full_requests_.find(request.ssrc);
      if (last != full_requests_.end() && last->second == *request.sequence) continue;
      constexpr std::size_t kMostReceivers = 1024;  // remembered
      if (full_requests_.size() >= kMostReceivers) full_requests_.clear();
      full_requests_[request.ssrc] = *request.sequence;
    }
    intra_wanted_ = true;
  }
}

bool RtpSender::intra_wanted(double now) {
  if (!intra_wanted_ || now < intra_given_ + kLeastIntraSeconds) return false;
  intra_wanted_ = false;
  intra_given_ = now;
  return true;
}

SendStats RtpSender::stats(double now) const {
  SendStats stats = stats_;
  stats.receivers = listeners_.count(now);
  stats.reported_loss = listeners_.loss(now);
  stats.sound_loss = listeners_.sound_loss(now);
  return stats;
}

}  // namespace animeme::media
