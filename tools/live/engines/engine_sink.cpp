#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "tools/formats/media/live/live_frames.h"
#include "tools/live/engines/detail/engine_address.h"
#include "tools/live/engines/detail/frame_grid.h"
#include "tools/live/engines/detail/live_link.h"
#include "tools/live/engines/detail/paced_sender.h"
#include "tools/live/engines/detail/unified.h"
#include "tools/live/engines/detail/vmc.h"
#include "tools/live/engines/engines.h"

namespace animeme::engines {
namespace {

using media::LiveInfo;
using media::LiveUnit;
using Datagrams = PacedSender::Datagrams;

constexpr const char* kSubject = "Animeme";
constexpr double kRounding = 1e-4;  // frames: what rounding may do to a time

fap::FillOptions shown(bool high_level) {
  fap::FillOptions options;
  options.complete = true;
  options.expand = !high_level;
  options.keep_high_level = high_level;
  return options;
}

/// Faces out of planes.
class FaceDecoder {
 public:
  explicit FaceDecoder(bool presets)
      : presets_(presets),
        plain_(media::GapRule::skip, shown(false)),
        high_(media::GapRule::skip, shown(true)) {}

  std::optional<Face> push(const LiveUnit& unit, std::uint32_t timescale) {
    const std::vector<fap::Frame> frames = plain_.push(unit, timescale, false);
    const std::vector<fap::Frame> high =
        presets_ ? high_.push(unit, timescale, false) : std::vector<fap::Frame>();
    if (frames.empty()) return std::nullopt;
    Face face;
    face.arkit = arkit_.fit(frames.back());
    if (!high.empty()) {
      face.presets = presets_fitter_.fit(frames.back(), high.back(), face.arkit);
    }
    return face;
  }
  fap::Rate rate() const { return plain_.rate(); }

 private:
  bool presets_;
  media::LiveFrames plain_, high_;  // without and with FAP 1 and 2
  fap::ArkitFitter arkit_;
  PresetFitter presets_fitter_;
};

/// Faces as datagrams.
class FaceWriter {
 public:
  explicit FaceWriter(const EngineAddress& address)
      : address_(address), unified_(address.prefix, address.gaze) {
    packet_.subject = address.subject.value_or(kSubject);
    packet_.device = device_of(packet_.subject);
  }

  Datagrams write(const TimedFace& face, const fap::Rate& rate) {
    if (address_.protocol == Protocol::live_link) return {live_link(face, rate)};
    if (address_.protocol == Protocol::vmc) {
      return osc_bundles(vmc_messages(face.face, face.seconds, address_.names, address_.bones));
    }
    return osc_bundles(unified_.write(face.face.arkit, face.seconds));
  }

  /// Nothing, where the protocol has no end.
  Datagrams end() {
    if (address_.protocol != Protocol::vmc) return {};
    const OscMessage message = vmc_end();
    return osc_bundles({&message, 1});
  }

 private:
  std::vector<std::uint8_t> live_link(const TimedFace& face, const fap::Rate& rate) {
    packet_.values = face.face.arkit;
    packet_.rate = std::int32_t(std::min<std::uint32_t>(rate.num, 1u << 30));
    packet_.denominator = std::int32_t(std::min<std::uint32_t>(rate.den, 1u << 30));
    const double frames = face.seconds * rate.frames_per_second();
    const double whole = std::floor(frames + kRounding);
    packet_.frame =
        std::int32_t(std::fmod(whole, double(std::numeric_limits<std::int32_t>::max())));
    packet_.part = float(std::clamp(frames - whole, 0.0, 0.9999));
    if (packet_.part < kRounding) packet_.part = 0;
    return write_live_link(packet_);
  }

  const EngineAddress address_;
  LiveLinkPacket packet_;
  UnifiedWriter unified_;
};

class EngineSink : public media::LiveSink {
 public:
  EngineSink(EngineAddress address, EngineSinkOptions options)
      : address_(std::move(address)),
        options_(std::move(options)),
        decoder_(address_.protocol == Protocol::vmc && address_.names != ShapeNames::arkit),
        writer_(address_),
        grid_(address_.rate) {}

  Result<void> start(const LiveInfo& info) override {
    if (info.face_config.empty()) {
      return make_error(Code::invalid_argument,
                        "there is no face to send, and engines do not accept sound");
    }
    timescale_ = info.timescale;
    if (options_.instead) return {};
    auto to = media::UdpAddress::resolve(address_.host, address_.port);
    if (!to) return to.error();
    auto socket = media::UdpSocket::open_for(*to);
    if (!socket) return socket.error();
    sender_ = std::make_unique<PacedSender>(std::move(*socket), *to);
    return {};
  }

  Result<void> send(const LiveUnit& unit) override {
    if (unit.track != media::LiveTrack::face || timescale_ == 0) return {};
    ++stats_.face_units;
    const std::optional<Face> face = decoder_.push(unit, timescale_);
    if (!face) return {};
    const fap::Rate rate = decoder_.rate();
    const double seconds = double(unit.time) / timescale_;
    // Time 0, as early as any plane says, so that one that was late makes none wait.
    zero_ = std::min(zero_, PacedSender::now() - seconds);
    const auto frames =
        grid_.push(seconds, double(unit.duration) / timescale_, rate.seconds(1), *face);
    return put_all(frames);
  }

  Result<void> poll() override { return {}; }

  Result<void> finish() override {
    if (auto ok = put_all(grid_.finish()); !ok) return ok;
    if (sender_) {
      if (auto ok = sender_->finish(); !ok) return ok;
    }
    if (!std::isfinite(zero_)) zero_ = PacedSender::now();  // nothing was sent
    auto ok = put(0, writer_.end());
    sender_.reset();
    timescale_ = 0;
    return ok;
  }

  media::SendStats stats() const override { return stats_; }

 private:
  Result<void> put_all(const std::vector<TimedFace>& frames) {
    const fap::Rate rate =
        address_.rate ? fap::make_rate(std::uint32_t(*address_.rate)) : decoder_.rate();
    for (const TimedFace& frame : frames) {
      if (auto ok = put(frame.seconds, writer_.write(frame, rate)); !ok) return ok;
    }
    return {};
  }

  Result<void> put(double seconds, Datagrams datagrams) {
    for (const auto& datagram : datagrams) {
      ++stats_.packets;
      stats_.bytes += std::int64_t(datagram.size());
      if (options_.instead) options_.instead(seconds, datagram);
    }
    if (!sender_) return {};
    const double instant = options_.fast ? 0 : zero_ + seconds + grid_.delay();
    return sender_->send(instant, std::move(datagrams));
  }

  const EngineAddress address_;
  const EngineSinkOptions options_;
  FaceDecoder decoder_;
  FaceWriter writer_;
  FrameGrid grid_;
  std::uint32_t timescale_ = 0;  // 0: not started
  double zero_ = std::numeric_limits<double>::infinity();
  std::unique_ptr<PacedSender> sender_;
  media::SendStats stats_;
};

}  // namespace

Result<std::unique_ptr<media::LiveSink>> make_engine_sink(const std::string& url,
                                                          const EngineSinkOptions& options) {
  auto address = parse_engine_address(url, false);
  if (!address) return address.error();
  return std::unique_ptr<media::LiveSink>(new EngineSink(std::move(*address), options));
}

}  // namespace animeme::engines
