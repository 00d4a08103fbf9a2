#include <algorithm>
#include <deque>
#include <exception>
#include <optional>

#include "tools/formats/media/live/audio_segments.h"
#include "tools/live/web/detail/client.h"
#include "tools/live/web/detail/messages.h"
#include "tools/live/web/web.h"

namespace animeme::web {
namespace {

using media::LiveEvent;
using media::LiveTrack;
using media::LiveUnit;

// Planes that wait for the first sound packet, which has the priming.
constexpr std::size_t kMostHeld = 64;
constexpr std::int64_t kMostHeldBytes = 1 << 20;
constexpr std::int64_t kLongestPriming = 4096;

class Source : public media::LiveSource {
 public:
  Source(WebAddress address, const WebOptions& options)
      : client_(std::move(address), options.queue_bytes) {}

  Result<void> connect() { return client_.connect(); }

  Result<LiveEvent> next(double seconds) override {
    try {
      const auto until =
          Client::Clock::now() +
          std::chrono::microseconds(std::int64_t(std::clamp(seconds, 0.0, 1e6) * 1e6));
      return wait(until);
    } catch (const std::exception& problem) {
      return make_error(Code::out_of_range, problem.what());
    }
  }

  media::ReceiveStats stats() const override { return stats_; }

 private:
  Result<LiveEvent> wait(Client::Clock::time_point until);
  Result<void> take(const Incoming& incoming);
  Result<void> take_face(std::span<const std::uint8_t> message);
  Result<void> take_sound(std::span<const std::uint8_t> message);
  void describe(bool whatever_is_known);

  Client client_;
  std::optional<Hello> hello_;
  std::optional<media::AudioFormat> format_;
  std::int64_t sound_end_ = -1;  // where the next segment should begin
  bool told_ = false, ended_ = false;
  std::deque<LiveEvent> events_;
  media::ReceiveStats stats_;
};

Result<LiveEvent> Source::wait(Client::Clock::time_point until) {
  for (;;) {
    const bool ready = told_ || ended_;
    if (ready && !events_.empty()) {
      Result<LiveEvent> event(std::move(events_.front()));
      events_.pop_front();
      return event;
    }
    if (ended_) return LiveEvent(media::LiveEnd{});
    auto incoming = client_.next(until);
    if (!incoming) {
      if (incoming.error().code != Code::end_of_stream) return incoming.error();
      describe(true);
      ended_ = true;
      continue;
    }
    if (!*incoming) return LiveEvent(media::LiveIdle{});
    if (Result<void> taken = take(**incoming); !taken) return taken.error();
  }
}

Result<void> Source::take(const Incoming& incoming) {
  ++stats_.packets;
  stats_.bytes += std::int64_t(incoming.bytes.size());
  Result<void> taken = incoming.sound ? take_sound(incoming.bytes) : take_face(incoming.bytes);
  describe(events_.size() > kMostHeld || stats_.bytes > kMostHeldBytes);
  return taken;
}

Result<void> Source::take_face(std::span<const std::uint8_t> message) {
  if (!hello_) {
    Result<Hello> hello = read_hello(message);
    if (!hello) return hello.error();
    hello_ = std::move(*hello);
    return {};
  }
  Result<UnitMessage> unit = read_unit(message);
  if (!unit) return unit.error();
  if ((unit->flags & kMissed) != 0) events_.emplace_back(media::LiveGap{LiveTrack::face, 0});
  const std::int64_t zero = std::int64_t(hello_->timescale) * kWebTimeZero;
  events_.emplace_back(LiveUnit{LiveTrack::face, std::move(unit->bytes),
                                (unit->flags & kIntra) != 0, std::int64_t(unit->time) - zero,
                                unit->duration});
  return {};
}

Result<void> Source::take_sound(std::span<const std::uint8_t> message) {
  if (!format_) {
    Result<media::AudioFormat> format = media::read_audio_init(message);
    if (!format) return format.error();
    format_ = std::move(*format);
    return {};
  }
  Result<std::vector<media::AudioPacket>> packets = media::read_audio_segment(message);
  if (!packets) return packets.error();
  for (media::AudioPacket& packet : *packets) {
    packet.time -= std::int64_t(format_->sample_rate) * kWebTimeZero;
    if (sound_end_ == -1 && packet.time < 0 && packet.time >= -kLongestPriming) {
      media::set_priming(*format_, int(-packet.time));
    }
    if (sound_end_ != -1 && packet.time != sound_end_) {
      events_.emplace_back(media::LiveGap{LiveTrack::audio, 0});
    }
    sound_end_ = packet.time + packet.duration;
    events_.emplace_back(
        LiveUnit{LiveTrack::audio, std::move(packet.bytes), false, packet.time, packet.duration});
  }
  return {};
}

/// Puts LiveInfo in front of what has been held, once it is known.
void Source::describe(bool whatever_is_known) {
  if (told_ || !hello_) return;
  const bool sound_begun = !hello_->has_sound || sound_end_ != -1;
  if (!sound_begun && !whatever_is_known) return;
  if (hello_->has_sound && !format_ && !whatever_is_known) return;
  events_.emplace_front(
      media::LiveInfo{hello_->config, hello_->timescale, hello_->visual_profile, format_});
  told_ = true;
}

}  // namespace

Result<std::unique_ptr<media::LiveSource>> make_web_source(const std::string& url,
                                                           const WebOptions& options) {
  Result<WebAddress> address = parse_web_address(url, true);
  if (!address) return address.error();
  if (address->port == 0) {
    return make_error(Code::invalid_argument, "the port of the server is missing");
  }
  auto source = std::make_unique<Source>(std::move(*address), options);
  Result<void> connected = source->connect();
  if (!connected) return connected.error();
  return std::unique_ptr<media::LiveSource>(std::move(source));
}

}  // namespace animeme::web
