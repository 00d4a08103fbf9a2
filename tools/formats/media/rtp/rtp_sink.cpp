#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/rtp/rtp.h"
#include "tools/formats/media/rtp/rtp_sender.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::media {
namespace {

constexpr int kPortsBehind = 3;  // RTCP of the face, RTP and RTCP of the sound

class RtpSink : public LiveSink {
 public:
  RtpSink(const UdpAddress& to, RtpOptions options) : to_(to), options_(std::move(options)) {}

  Result<void> start(const LiveInfo& info) override {
    if (auto ok = check(info, options_); !ok) return ok;
    const Multicast multicast{options_.ttl, options_.interface};
    for (std::optional<UdpSocket>* socket : {&media_, &control_}) {
      Result<UdpSocket> opened = UdpSocket::open_for(to_, multicast);
      if (!opened) return opened.error();
      *socket = std::move(*opened);
    }
    begin_ = steady_clock().now();
    sender_.emplace(info, options_, to_.host(), to_.port(),
                    options_.seed ? *options_.seed : random_number(), ntp_now());
    if (options_.sdp_path.empty()) return {};
    return tools::write_file(options_.sdp_path, write_sdp(sender_->session()));
  }

  Result<void> send(const LiveUnit& unit) override {
    if (!sender_) return make_error(Code::invalid_argument, "start() comes before send()");
    RtpSender::Datagrams out;
    if (auto ok = sender_->send(unit, now(), out); !ok) return ok;
    return transmit(out);
  }

  Result<void> poll() override {
    if (!sender_) return {};
    constexpr int kMostAtOnce = 64;
    for (int i = 0; i < kMostAtOnce; ++i) {
      const auto got = control_->receive();
      if (!got) return got.error();
      if (!*got) break;
      sender_->rtcp(**got, now());
    }
    RtpSender::Datagrams out;
    sender_->poll(now(), out);
    return transmit(out);
  }

  bool intra_wanted() override {
    // What has just arrived counts for the next plane.
    return sender_ && poll() && sender_->intra_wanted(now());
  }

  Result<void> finish() override {
    if (!sender_) return {};
    RtpSender::Datagrams out;
    sender_->finish(now(), out);
    const Result<void> sent = transmit(out);
    stats_ = sender_->stats(now());
    sender_.reset();
    media_.reset();
    control_.reset();
    return sent;
  }

  SendStats stats() const override { return sender_ ? sender_->stats(now()) : stats_; }

 private:
  double now() const { return steady_clock().now() - begin_; }

  Result<void> transmit(const RtpSender::Datagrams& datagrams) {
    for (const RtpDatagram& each : datagrams) {
      const int behind = (each.track == LiveTrack::audio ? 2 : 0) + (each.control ? 1 : 0);
      UdpSocket& socket = each.control ? *control_ : *media_;
      if (auto ok = socket.send(each.bytes, to_.with_port(to_.port() + behind)); !ok) return ok;
    }
    return {};
  }

  UdpAddress to_;
  RtpOptions options_;
  std::optional<UdpSocket> media_;
  std::optional<UdpSocket> control_;
  std::optional<RtpSender> sender_;
  double begin_ = 0;
  SendStats stats_;
};

}  // namespace

Result<std::unique_ptr<LiveSink>> make_rtp_sink(const std::string& url, const RtpOptions& options) {
  const Result<HostPort> where = read_host_port(url, kRtpPort);
  if (!where) return where.error();
  if (where->host.empty()) {
    return make_error(Code::invalid_argument, "'" + url + "' does not say where to send to");
  }
  if (where->port == 0 || where->port % 2 != 0 || where->port > 65535 - kPortsBehind) {
    return make_error(Code::invalid_argument, "RTP needs an even port from 2 to 65532");
  }
  // Without a presentation yet: the options alone.
  LiveInfo any;
  any.face_config = {0};
  if (auto ok = check(any, options); !ok) return ok.error();
  const Result<UdpAddress> to = UdpAddress::resolve(where->host, where->port);
  if (!to) return to.error();
  return std::unique_ptr<LiveSink>(std::make_unique<RtpSink>(*to, options));
}

}  // namespace animeme::media
