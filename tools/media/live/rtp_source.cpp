#include <algorithm>
#include <fstream>
#include <utility>

#include "tools/media/detail/invalid.h"
#include "tools/media/live/pacer.h"
#include "tools/media/live/rtp.h"
#include "tools/media/live/rtp_receiver.h"
#include "tools/media/live/udp_socket.h"

namespace animeme::media {
namespace {

constexpr int kMostAtOnce = 256;  // datagrams of a socket before events are given out

struct Inlet {
  LiveTrack track = LiveTrack::face;
  bool control = false;
  UdpSocket socket;
  std::optional<UdpAddress> reporter;  // where the last sender report came from
};

class RtpSource : public LiveSource {
 public:
  RtpSource(RtpReceiver receiver, std::vector<Inlet> inlets)
      : receiver_(std::move(receiver)), inlets_(std::move(inlets)) {}

  Result<LiveEvent> next(double seconds) override {
    const double end = now() + std::max(0.0, seconds);
    for (;;) {
      const Result<bool> came = read_all();
      if (!came) return came.error();
      if (auto ok = report(); !ok) return ok.error();
      const double at = now();
      if (std::optional<LiveEvent> event = receiver_.next(at)) return std::move(*event);
      if (at >= end) return LiveEvent(LiveIdle{});
      if (*came) continue;
      const double until = std::min(end, receiver_.deadline().value_or(end));
      const Result<bool> waited = wait_for_any(sockets(), until - at);
      if (!waited) return waited.error();
    }
  }

  ReceiveStats stats() const override { return receiver_.stats(); }

 private:
  double now() const { return steady_clock().now() - begin_; }

  std::vector<const UdpSocket*> sockets() const {
    std::vector<const UdpSocket*> all;
    for (const Inlet& inlet : inlets_) all.push_back(&inlet.socket);
    return all;
  }

  Result<bool> read_all() {
    bool any = false;
    for (Inlet& inlet : inlets_) {
      for (int i = 0; i < kMostAtOnce; ++i) {
        UdpAddress from;
        const auto got = inlet.socket.receive(&from);
        if (!got) return got.error();
        if (!*got) break;
        any = true;
        if (inlet.control) {
          inlet.reporter = from;
          receiver_.rtcp(inlet.track, **got, now());
        } else {
          receiver_.rtp(inlet.track, **got, now());
        }
      }
    }
    return any;
  }

  Result<void> report() {
    for (const RtpDatagram& report : receiver_.reports(now())) {
      for (Inlet& inlet : inlets_) {
        if (inlet.track != report.track || !inlet.reporter) continue;
        if (auto ok = inlet.socket.send(report.bytes, *inlet.reporter); !ok) return ok;
      }
    }
    return {};
  }

  const double begin_ = steady_clock().now();
  RtpReceiver receiver_;
  std::vector<Inlet> inlets_;
};

Result<void> check(const RtpReceiveOptions& options) {
  const auto within = [](double value, double most) { return value >= 0 && value <= most; };
  if (!within(options.reorder_seconds, 10)) return invalid("reorder_seconds must be 0..10");
  if (!within(options.sync_seconds, 10)) return invalid("sync_seconds must be 0..10");
  if (!within(options.reorder_packets, 1000)) return invalid("reorder_packets must be 0..1000");
  return {};
}

// The address to listen at for packets that a description says go to `address`: a group, this
// machine alone, or all addresses.
Result<std::string> listening_address(const std::string& address) {
  if (address.empty()) return std::string("0.0.0.0");
  const Result<UdpAddress> resolved = UdpAddress::resolve(address, 0);
  if (!resolved) return resolved.error();
  if (resolved->is_multicast() || resolved->is_loopback()) return address;
  return std::string(resolved->is_ipv6() ? "::" : "0.0.0.0");
}

Result<void> open_inlets(const RtpTrack& track, LiveTrack which, const std::string& interface,
                         std::vector<Inlet>& inlets) {
  for (const bool control : {false, true}) {
    Result<UdpSocket> socket = UdpSocket::bind(
        track.address, control ? track.rtcp_port : track.port, {.interface = interface});
    if (!socket) return socket.error();
    inlets.push_back({which, control, std::move(*socket), std::nullopt});
  }
  return {};
}

// A face alone, of which nothing is known but the port.
Result<RtpSession> session_at(const std::string& url) {
  const Result<HostPort> where = read_host_port(url, kRtpPort);
  if (!where) return where.error();
  if (where->port == 0 || where->port > 65534) {
    return make_error(Code::invalid_argument, "RTP wants a port from 1 to 65534");
  }
  RtpSession session;
  RtpFaceTrack& face = session.face.emplace();
  face.address = where->host.empty() ? "0.0.0.0" : where->host;
  face.port = where->port;
  face.rtcp_port = where->port + 1;
  face.payload_type = -1;
  face.clock = kFaceClock;
  face.bundle_id = kBundleExtensionId;
  return session;
}

Result<RtpSession> session_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return make_error(Code::not_found, "there is no session description here").in_file(path);
  }
  constexpr std::size_t kEnough = 1 << 17;
  std::string text(kEnough, '\0');
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(file.gcount()));
  Result<RtpSession> session = read_sdp(text);
  if (!session) return std::move(session.error()).in_file(path);
  for (RtpTrack* track : {static_cast<RtpTrack*>(session->face ? &*session->face : nullptr),
                          static_cast<RtpTrack*>(session->audio ? &*session->audio : nullptr)}) {
    if (track == nullptr) continue;
    const Result<std::string> address = listening_address(track->address);
    if (!address) return address.error().in_file(path);
    track->address = *address;
  }
  return session;
}

}  // namespace

Result<std::unique_ptr<LiveSource>> make_rtp_source(const std::string& where,
                                                    const RtpReceiveOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  const bool address = where.starts_with("rtp://");
  const Result<RtpSession> session = address ? session_at(where) : session_in(where);
  if (!session) return session.error();
  std::vector<Inlet> inlets;
  if (session->face) {
    auto ok = open_inlets(*session->face, LiveTrack::face, options.interface, inlets);
    if (!ok) return ok.error();
  }
  if (session->audio) {
    auto ok = open_inlets(*session->audio, LiveTrack::audio, options.interface, inlets);
    if (!ok) return ok.error();
  }
  RtpReceiver receiver(*session, options, std::uint32_t(random_number()));
  return std::unique_ptr<LiveSource>(
      std::make_unique<RtpSource>(std::move(receiver), std::move(inlets)));
}

}  // namespace animeme::media
