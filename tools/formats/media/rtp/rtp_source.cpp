#include <sys/stat.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <utility>

#include "tools/formats/media/detail/ffmpeg/invalid.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/rtp/rtp.h"
#include "tools/formats/media/rtp/rtp_receiver.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::media {
namespace {

constexpr int kMostAtOnce = 256;    // datagrams of a socket before events are given out
constexpr double kLookEvery = 0.2;  // at the file of the description, seconds

struct Inlet {
  LiveTrack track = LiveTrack::face;
  bool control = false;
  UdpSocket socket;
  std::optional<UdpAddress> reporter;  // where the last sender report came from
};

// What a description, or an address, says: read again when its file changes.
struct Description {
  std::string path;  // empty: an address, which does not change
  struct stat file {};
  RtpSession session;
};

bool has_changed(const Description& description) {
  struct stat now {};
  if (description.path.empty() || ::stat(description.path.c_str(), &now) != 0) return false;
  const struct stat& was = description.file;
  return now.st_ino != was.st_ino || now.st_size != was.st_size ||
         now.st_mtim.tv_sec != was.st_mtim.tv_sec || now.st_mtim.tv_nsec != was.st_mtim.tv_nsec;
}

Result<void> check(const RtpReceiveOptions& options) {
  const auto within = [](double value, double most) { return value >= 0 && value <= most; };
  if (!within(options.reorder_seconds, 10)) return invalid("reorder_seconds must be 0..10");
  if (!within(options.reorder_most_seconds, 10)) {
    return invalid("reorder_most_seconds must be 0..10");
  }
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

Result<void> open_inlets_of(const RtpTrack& track, LiveTrack which, const std::string& interface,
                            std::vector<Inlet>& inlets) {
  for (const bool control : {false, true}) {
    Result<UdpSocket> socket = UdpSocket::bind(
        track.address, control ? track.rtcp_port : track.port, {.interface = interface});
    if (!socket) return socket.error();
    inlets.push_back({which, control, std::move(*socket), std::nullopt});
  }
  return {};
}

Result<std::vector<Inlet>> open_inlets(const RtpSession& session, const std::string& interface) {
  std::vector<Inlet> inlets;
  if (session.face) {
    auto ok = open_inlets_of(*session.face, LiveTrack::face, interface, inlets);
    if (!ok) return ok.error();
  }
  if (session.audio) {
    auto ok = open_inlets_of(*session.audio, LiveTrack::audio, interface, inlets);
    if (!ok) return ok.error();
  }
  return inlets;
}

bool same_ports(const RtpSession& a, const RtpSession& b) {
  const auto ports = [](const auto& track) {
    return track ? track->address + ' ' + std::to_string(track->port) + ' ' +
                       std::to_string(track->rtcp_port)
                 : std::string();
  };
  return ports(a.face) == ports(b.face) && ports(a.audio) == ports(b.audio);
}

// A face alone, of which nothing is known but the port.
Result<Description> describe_address(const std::string& url) {
  const Result<HostPort> where = read_host_port(url, kRtpPort);
  if (!where) return where.error();
  if (where->port == 0 || where->port > 65534) {
    return make_error(Code::invalid_argument, "RTP needs a port from 1 to 65534");
  }
  Description description;
  RtpFaceTrack& face = description.session.face.emplace();
  face.address = where->host.empty() ? "0.0.0.0" : where->host;
  face.port = where->port;
  face.rtcp_port = where->port + 1;
  face.payload_type = -1;
  face.clock = kFaceClock;
  face.bundle_id = kBundleExtensionId;
  return description;
}

Result<Description> describe_file(const std::string& path) {
  Description description;
  description.path = path;
  (void)::stat(path.c_str(), &description.file);
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
  description.session = std::move(*session);
  return description;
}

class RtpSource : public LiveSource {
 public:
  RtpSource(Description description, const RtpReceiveOptions& options, std::vector<Inlet> inlets)
      : options_(options),
        id_(std::uint32_t(random_number())),
        description_(std::move(description)),
        receiver_(description_.session, options, id_),
        inlets_(std::move(inlets)) {}

  Result<LiveEvent> next(double seconds) override {
    const double end = now() + std::max(0.0, seconds);
    for (;;) {
      if (auto ok = look_at_description(); !ok) return ok.error();
      const Result<bool> came = read_all();
      if (!came) return came.error();
      if (auto ok = report(); !ok) return ok.error();
      const double at = now();
      if (!left_.empty()) {
        LiveEvent event = std::move(left_.front());
        left_.pop_front();
        return event;
      }
      if (std::optional<LiveEvent> event = receiver_.next(at)) return std::move(*event);
      if (at >= end) return LiveEvent(LiveIdle{});
      if (*came) continue;
      const double until = std::min({end, receiver_.deadline().value_or(end), look_at_});
      const Result<bool> waited = wait_for_any(sockets(), until - at);
      if (!waited) return waited.error();
    }
  }

  ReceiveStats stats() const override {
    ReceiveStats all = before_;
    return all += receiver_.stats();
  }

 private:
  double now() const { return steady_clock().now() - begin_; }

  std::vector<const UdpSocket*> sockets() const {
    std::vector<const UdpSocket*> all;
    for (const Inlet& inlet : inlets_) all.push_back(&inlet.socket);
    return all;
  }

  // true: the ports are others than before.
  Result<bool> look_at_description() {
    const double at = now();
    if (at < look_at_) return false;
    look_at_ = description_.path.empty() ? 1e9 : at + kLookEvery;
    if (!has_changed(description_)) return false;
    Result<Description> fresh = describe_file(description_.path);
    if (!fresh) return false;  // it is just being written, or gone
    const bool same = fresh->session == description_.session;
    description_.file = fresh->file;
    if (same) return false;
    return follow(std::move(*fresh), at);
  }

  // The old sender's events come first, then what the new one has sent already.
  Result<bool> follow(Description fresh, double at) {
    const bool moved = !same_ports(fresh.session, description_.session);
    if (moved) {
      inlets_.clear();  // it may want some of these ports
      auto opened = open_inlets(fresh.session, options_.interface);
      if (!opened) return opened.error();
      inlets_ = std::move(*opened);
    }
    receiver_.flush(at);
    while (std::optional<LiveEvent> event = receiver_.next(at)) left_.push_back(std::move(*event));
    before_ = stats();
    if (before_.sessions > 0) left_.emplace_back(LiveRestart{});
    RtpReceiver next(fresh.session, options_, id_);
    for (const LiveTrack track : {LiveTrack::face, LiveTrack::audio}) {
      for (const RtpInput::Early& each : receiver_.early(track)) {
        next.rtp(track, each.bytes, each.from, each.at);
      }
    }
    receiver_ = std::move(next);
    description_ = std::move(fresh);
    return moved;
  }

  // A sender that begins again writes its description before its first packet. It is read before
  // that packet is judged: else the packet begins one presentation and the description another.
  Result<bool> read_all() {
    bool any = false;
    for (Inlet& inlet : inlets_) {
      for (int i = 0; i < kMostAtOnce; ++i) {
        UdpAddress from;
        const auto got = inlet.socket.receive(&from);
        if (!got) return got.error();
        if (!*got) break;
        any = true;
        const LiveTrack track = inlet.track;
        if (inlet.control) {
          if (receiver_.rtcp(track, **got, from, now())) inlet.reporter = from;
        } else if (receiver_.hears(track, **got, from)) {
          receiver_.rtp(track, **got, from, now());
        } else {
          look_at_ = 0;
          const Result<bool> moved = look_at_description();
          if (!moved) return moved.error();
          receiver_.rtp(track, **got, from, now());
          if (*moved) return true;  // these inlets are gone
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
  RtpReceiveOptions options_;
  std::uint32_t id_;
  Description description_;
  double look_at_ = 0;
  RtpReceiver receiver_;
  std::vector<Inlet> inlets_;
  std::deque<LiveEvent> left_;  // of the sender before the description changed
  ReceiveStats before_;         // likewise
};

}  // namespace

Result<std::unique_ptr<LiveSource>> make_rtp_source(const std::string& where,
                                                    const RtpReceiveOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  const bool address = where.starts_with("rtp://");
  Result<Description> description = address ? describe_address(where) : describe_file(where);
  if (!description) return description.error();
  auto inlets = open_inlets(description->session, options.interface);
  if (!inlets) return inlets.error();
  return std::unique_ptr<LiveSource>(
      std::make_unique<RtpSource>(std::move(*description), options, std::move(*inlets)));
}

}  // namespace animeme::media
