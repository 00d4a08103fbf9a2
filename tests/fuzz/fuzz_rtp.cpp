// libFuzzer entry: packets, descriptions and reports of RTP, and a receiver that is fed with them.
// The first byte says which: 'd' a description, 'p' a packet, 'c' RTCP, else a receiver. For that
// the second byte is the session (bit 0: sound is Opus, bit 1: no configuration, bit 2: no clock),
// then come records: a byte (bit 0: sound, bit 1: RTCP, the others: 10 ms of time each), two bytes
// of size, whose two upper bits are the address, a datagram. Times on a SessionClock ascend and run
// ahead of the arrival by no more than data and a few seconds.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/formats/media/live/recovery.h"
#include "tools/formats/media/rtp/rtp_receiver.h"
#include "tools/formats/media/rtp/session_clock.h"

using animeme::test::require;

namespace {

using namespace animeme::media;
using Bytes = std::span<const std::uint8_t>;

void read_description(Bytes text) {
  const auto session = read_sdp({reinterpret_cast<const char*>(text.data()), text.size()});
  if (!session) return;
  require(session->face || session->audio);
  require(bool(read_sdp(write_sdp(*session))));
}

void read_packet(Bytes datagram) {
  const auto packet = read_rtp(datagram, kBundleExtensionId);
  if (!packet) return;
  require(packet->payload.size() <= datagram.size());
  require(read_rtp(write_rtp(*packet), kBundleExtensionId) == packet);
}

void read_reports(Bytes datagram) {
  const auto message = read_rtcp(datagram);
  if (!message || message->reports.empty()) return;
  (void)read_rtcp(write_rtcp(*message));
}

RtpSession session_of(std::uint8_t flags) {
  RtpSession session;
  RtpFaceTrack& face = session.face.emplace();
  face.clock = kFaceClock;
  face.bundle_id = kBundleExtensionId;
  face.timescale = 30000;
  if ((flags & 2) == 0) face.config = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47};
  RtpAudioTrack& audio = session.audio.emplace();
  audio.payload_type = 97;
  audio.clock = 48000;
  audio.format.codec = (flags & 1) != 0 ? AudioCodec::opus : AudioCodec::aac;
  if ((flags & 4) == 0) {
    face.ssrc = 0x11111111;
    face.clock_offset = 5;
    audio.ssrc = 0x22222222;
    audio.clock_offset = 6;
  }
  return session;
}

/// What a recording would be made of.
class Steady {
 public:
  void push(LiveEvent event, double now) {
    std::deque<LiveEvent> out;
    clock_.push(std::move(event), now, out);
    for (LiveEvent& each : out) {
      if (const auto* info = std::get_if<LiveInfo>(&each)) info_ = *info;
      if (const auto* unit = std::get_if<LiveUnit>(&each)) look(*unit, now);
    }
  }

 private:
  void look(const LiveUnit& unit, double now) {
    require(info_.has_value());
    const bool face = unit.track == LiveTrack::face;
    const double rate = face ? info_->timescale : info_->audio ? info_->audio->sample_rate : 1;
    const double time = double(unit.time) / std::max(1.0, rate);
    std::optional<std::int64_t>& last = last_[face ? 0 : 1];
    require(!last || unit.time > *last);
    last = unit.time;
    if (!begin_) begin_ = time - now;
    ++units_;
    require(time <= *begin_ + now + 20 + 0.5 * units_);
  }

  SessionClock clock_;
  std::optional<LiveInfo> info_;
  std::optional<std::int64_t> last_[2];
  std::optional<double> begin_;
  double units_ = 0;
};

const UdpAddress& address(int number) {
  static const UdpAddress all[4] = {{},
                                    *UdpAddress::resolve("192.0.2.1", 4000),
                                    *UdpAddress::resolve("192.0.2.1", 4001),
                                    *UdpAddress::resolve("192.0.2.2", 4000)};
  return all[number];
}

void receive(Bytes input) {
  if (input.empty()) return;
  RtpReceiver receiver(session_of(input[0]), {}, 1);
  FaceRecovery recovery;
  Steady steady;
  input = input.subspan(1);
  double now = 0;
  bool begun = false;
  const auto take = [&] {
    while (auto event = receiver.next(now)) {
      begun = begun || std::holds_alternative<LiveInfo>(*event);
      if (const auto* unit = std::get_if<LiveUnit>(&*event)) {
        require(begun && !unit->bytes.empty() && unit->duration > 0);
      }
      steady.push(*event, now);
      (void)recovery.accept(std::move(*event));
    }
  };
  while (input.size() >= 3) {
    const std::uint8_t head = input[0];
    const UdpAddress& from = address(input[1] >> 6);
    const std::size_t size =
        std::min<std::size_t>((input[1] & 63) * 256u + input[2], input.size() - 3);
    const Bytes datagram = input.subspan(3, size);
    input = input.subspan(3 + size);
    now += 0.01 * (head >> 2);
    const LiveTrack track = (head & 1) != 0 ? LiveTrack::audio : LiveTrack::face;
    if ((head & 2) != 0) {
      receiver.rtcp(track, datagram, from, now);
    } else {
      receiver.rtp(track, datagram, from, now);
    }
    take();
    (void)receiver.reports(now);
    (void)receiver.deadline();
  }
  now += 10;
  take();
  const RecoveryStats& stats = recovery.stats();
  require(stats.share() >= 0 && stats.share() <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes rest(data + 1, size - 1);
  switch (data[0]) {
    case 'd':
      read_description(rest);
      break;
    case 'p':
      read_packet(rest);
      break;
    case 'c':
      read_reports(rest);
      break;
    default:
      receive(rest);
      break;
  }
  return 0;
}
