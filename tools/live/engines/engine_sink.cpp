#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/live/live_frames.h"
#include "tools/formats/media/rtp/udp_socket.h"
#include "tools/live/engines/detail/engine_address.h"
#include "tools/live/engines/detail/face.h"
#include "tools/live/engines/detail/live_link.h"
#include "tools/live/engines/detail/unified.h"
#include "tools/live/engines/detail/vmc.h"
#include "tools/live/engines/engines.h"

namespace animeme::engines {

namespace {

class PacedSender {
 public:
  using Datagrams = std::vector<std::vector<std::uint8_t>>;

  PacedSender(media::UdpSocket socket, const media::UdpAddress& to)
      : socket_(std::move(socket)), to_(to) {}
  ~PacedSender();
  PacedSender(const PacedSender&) = delete;
  PacedSender& operator=(const PacedSender&) = delete;

  // Seconds of a steady clock, that of the instants.
  static double now();
  // Instants ascend. Errors: io, also of what went out before.
  Result<void> send(double instant, Datagrams datagrams);
  // Waits until everything has gone out.
  Result<void> finish();

 private:
  struct Waiting {
    double instant;
    Datagrams datagrams;
  };
  void run();
  void put(const Datagrams& datagrams);  // with the lock held

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::optional<Error> error_;
  bool stop_ = false;
  media::UdpSocket socket_;
  media::UdpAddress to_;
  std::thread thread_;
};

using SteadyClock = std::chrono::steady_clock;

SteadyClock::time_point point_of(double instant) {
  const std::chrono::duration<double> since(instant);
  return SteadyClock::time_point(std::chrono::ceil<SteadyClock::duration>(since));
}

double PacedSender::now() {
  return std::chrono::duration<double>(SteadyClock::now().time_since_epoch()).count();
}

PacedSender::~PacedSender() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PacedSender::put(const Datagrams& datagrams) {
  for (const auto& datagram : datagrams) {
    if (auto sent = socket_.send(datagram, to_); !sent && !error_) error_ = sent.error();
  }
}

Result<void> PacedSender::send(double instant, Datagrams datagrams) {
  {
    const std::lock_guard lock(mutex_);
    if (error_) return *error_;
    if (waiting_.empty() && instant <= now()) {
      put(datagrams);
      return error_ ? Result<void>(*error_) : Result<void>();
    }
    waiting_.push_back({instant, std::move(datagrams)});
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  changed_.notify_all();
  return {};
}

void PacedSender::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (waiting_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const double instant = waiting_.front().instant;
    if (instant > now()) {
      changed_.wait_until(lock, point_of(instant));
      continue;
    }
    put(waiting_.front().datagrams);
    waiting_.pop_front();
    if (waiting_.empty()) changed_.notify_all();
  }
}

Result<void> PacedSender::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty(); });
  return error_ ? Result<void>(*error_) : Result<void>();
}

struct TimedFace {
  double seconds = 0;  // presentation time
  Face face;
};

class FrameGrid {
 public:
  // `rate`: frames a second; nothing: as many as there are planes.
  explicit FrameGrid(std::optional<double> rate) : rate_(rate) {}

  // The frames that are known once a plane is there, ascending: with a rate those up to it, on
  // the way from the plane before, and those while it holds. That way is one frame of the
  // stream long, `period` seconds: a plane that is shown for longer stays as it is until then.
  std::vector<TimedFace> push(double seconds, double duration, double period, const Face& face);
  // Those that are left when the last plane is over.
  std::vector<TimedFace> finish();
  // How much later than their time frames can go out, all of them: seconds, after a plane.
  double delay() const { return rate_ ? period_ : 0; }

 private:
  std::optional<double> rate_;
  double period_ = 0;
  double end_ = 0;                 // of the last plane
  std::optional<TimedFace> last_;  // plane
  double next_ = 0;                // place on the grid
};

constexpr double kMostHold = 10;  // seconds that a plane is sent again at most
constexpr double kLittle = 1e-6;  // seconds: what rounding may do

std::vector<TimedFace> FrameGrid::push(double seconds, double duration, double period,
                                       const Face& face) {
  period_ = period;
  std::vector<TimedFace> out;
  const double held = std::min(duration, kMostHold);
  if (!rate_) {
    for (double at = 0; at == 0 || at < held - period / 2; at += period) {
      out.push_back({seconds + at, face});
    }
    return out;
  }
  const bool first = !last_ || seconds < last_->seconds;
  if (first) next_ = std::ceil((seconds - kLittle) * *rate_);
  const double begin = first ? seconds : std::max(last_->seconds, seconds - period);
  // A pause that was longer than is sent again leaves its places out.
  next_ = std::max(next_, std::ceil((begin - kLittle) * *rate_));
  for (; next_ / *rate_ < seconds + held - period + kLittle || next_ / *rate_ <= seconds + kLittle;
       ++next_) {
    const double at = next_ / *rate_;
    const bool on_the_way = !first && at < seconds - kLittle && seconds > begin;
    out.push_back({at, on_the_way ? between(last_->face, face,
                                            std::clamp((at - begin) / (seconds - begin), 0.0, 1.0))
                                  : face});
  }
  last_ = TimedFace{seconds, face};
  end_ = seconds + held;
  return out;
}

std::vector<TimedFace> FrameGrid::finish() {
  std::vector<TimedFace> out;
  if (!last_) return out;
  for (; next_ / *rate_ < end_ - kLittle; ++next_) out.push_back({next_ / *rate_, last_->face});
  last_.reset();
  return out;
}

using media::LiveInfo;
using media::LiveUnit;
using Datagrams = PacedSender::Datagrams;

// Six letters: some receivers take packets of a phone's length alone (live_link.h).
constexpr const char* kSubject = "Avatar";
constexpr double kDay = 86400;      // seconds
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

/// Seconds since midnight here.
double time_of_day() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t whole = std::chrono::system_clock::to_time_t(now);
  std::tm local{};
  if (::localtime_r(&whole, &local) == nullptr) return 0;
  const auto since = now - std::chrono::system_clock::from_time_t(whole);
  return 3600.0 * local.tm_hour + 60.0 * local.tm_min + local.tm_sec +
         std::chrono::duration<double>(since).count();
}

/// Faces as datagrams.
class FaceWriter {
 public:
  explicit FaceWriter(const EngineAddress& address)
      : address_(address), unified_(address.prefix, address.gaze, address.binary) {
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
    if (address_.time_of_day && !midnight_) midnight_ = time_of_day() - face.seconds;
    const double seconds = face.seconds + midnight_.value_or(0);
    const double frames =
        (midnight_ ? std::fmod(seconds, kDay) : seconds) * rate.frames_per_second();
    const double whole = std::floor(frames + kRounding);
    packet_.frame =
        std::int32_t(std::fmod(whole, double(std::numeric_limits<std::int32_t>::max())));
    packet_.part = float(std::clamp(frames - whole, 0.0, 0.9999));
    if (packet_.part < kRounding) packet_.part = 0;
    return write_live_link(packet_);
  }

  const EngineAddress address_;
  LiveLinkPacket packet_;
  std::optional<double> midnight_;  // time of day at presentation time 0
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
