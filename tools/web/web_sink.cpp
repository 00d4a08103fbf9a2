#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "tools/media/detail/words_internal.h"
#include "tools/media/live/audio_segments.h"
#include "tools/web/detail/headers.h"
#include "tools/web/detail/messages.h"
#include "tools/web/detail/server.h"
#include "tools/web/detail/values.h"
#include "tools/web/web.h"

namespace animeme::web {
namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr double kSoundBefore = 0.25;  // seconds of it that newcomers get before the face
constexpr double kSoundAlone = 1;      // the same where there is no face

Error invalid(const char* what) { return make_error(Code::invalid_argument, what); }

bool is_plain(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

template <class Body>
Result<void> guarded(const Body& body) {
  try {
    return body();
  } catch (const std::exception& problem) {
    return make_error(Code::out_of_range, problem.what());
  }
}

class Sink : public WebSink {
 public:
  Sink(WebAddress address, const WebOptions& options)
      : address_(std::move(address)), options_(options) {}

  Result<void> start(const media::LiveInfo& info) override {
    return guarded([&] { return begin(info); });
  }
  Result<void> send(const LiveUnit& unit) override {
    return guarded([&]() -> Result<void> {
      if (!server_ || over_) return invalid("the sink is not running");
      return unit.track == LiveTrack::face ? send_face(unit) : send_sound(unit);
    });
  }
  Result<void> poll() override { return {}; }

  Result<void> finish() override {
    return guarded([&]() -> Result<void> {
      if (!server_ || over_) return {};
      Result<void> flushed = flush();
      over_ = true;
      if (peers_) peers_->finish();
      server_->finish();
      return flushed;
    });
  }

  media::SendStats stats() const override {
    media::SendStats stats = server_ ? server_->stats() : media::SendStats{};
    if (peers_) {
      const media::SendStats more = peers_->stats();
      stats.receivers += more.receivers;
      stats.packets += more.packets;
      stats.bytes += more.bytes;
      stats.dropped += more.dropped;
      stats.repeated += more.repeated;
    }
    stats.face_units = face_units_;
    stats.audio_units = audio_units_;
    return stats;
  }

  std::string address() const override {
    if (!server_) return {};
    return WebAddress{address_.host, server_->port()}.text();
  }

 private:
  Result<void> begin(const media::LiveInfo& info);
  Result<void> send_face(const LiveUnit& unit);
  Result<void> send_sound(const LiveUnit& unit);
  Result<void> flush();
  void describe();

  const WebAddress address_;
  const WebOptions options_;
  media::LiveInfo info_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<Peers> peers_;  // nullptr: no WebRTC
  bool over_ = false;
  Values values_;
  std::vector<media::AudioPacket> packets_;  // of the next segment
  std::uint32_t segments_ = 0;
  double now_ = 0;  // on the clock of the segments
  std::int64_t face_units_ = 0, audio_units_ = 0;
};

Result<void> Sink::begin(const media::LiveInfo& info) {
  if (server_) return invalid("the sink has been started already");
  if (info.face_config.empty() && !info.audio) return invalid("there is neither face nor sound");
  if (info.timescale == 0) return invalid("the time scale is 0");
  info_ = info;
  std::vector<std::uint8_t> init;
  if (info_.audio) {
    Result<std::vector<std::uint8_t>> written = media::write_audio_init(*info_.audio);
    if (!written) return written.error();
    init = std::move(*written);
  }
  auto server = Server::listen(address_, options_, info_.audio ? info_.audio->sample_rate : 0);
  if (!server) return server.error();
  const Hello hello{info_.visual_profile, info_.audio.has_value(), info_.timescale,
                    info_.face_config};
  (*server)->set_hello(Channel::face, {.bytes = write_hello(hello)});
  const std::string names = values_hello();
  (*server)->set_hello(Channel::faps, {.bytes = {names.begin(), names.end()}, .text = true});
  if (!init.empty()) (*server)->set_hello(Channel::audio, {.bytes = std::move(init)});
  if (options_.make_peers) {
    peers_ = options_.make_peers();
    Result<void> ready = peers_->start(info_, options_.max_clients, options_.per_address);
    if (!ready && options_.must_have_peers) return ready;
    if (!ready) peers_.reset();
  }
  (*server)->set_peers(peers_);
  server_ = std::move(*server);
  describe();
  server_->serve();
  return {};
}

/// /info.json
void Sink::describe() {
  nlohmann::ordered_json json{{"version", kVersion}, {"time_zero", kWebTimeZero}, {"now", now_}};
  if (!info_.face_config.empty()) {
    json["face"] = {{"timescale", info_.timescale},
                    {"profile", info_.visual_profile},
                    {"config", media::lower_case(media::to_hex(info_.face_config))}};
  }
  if (info_.audio) {
    json["audio"] = {{"mime", media::audio_mime(*info_.audio)},
                     {"codec", media::name_of(info_.audio->codec)},
                     {"sample_rate", info_.audio->sample_rate},
                     {"channels", info_.audio->channels}};
  }
  if (peers_) json["webrtc"] = true;  // at /whep
  json["clients"] = stats().receivers;
  server_->set_info(json.dump());
}

Result<void> Sink::send_face(const LiveUnit& unit) {
  if (info_.face_config.empty()) return invalid("start() was not told of a face");
  const std::int64_t time = unit.time + std::int64_t(info_.timescale) * kWebTimeZero;
  if (time < 0) return invalid("a unit lies more than a second before time 0");
  if (unit.duration < 0 || unit.duration > UINT32_MAX || unit.bytes.empty()) {
    return invalid("a unit is empty or its duration does not fit in 32 bits");
  }
  const double seconds = double(time) / info_.timescale;
  now_ = std::max(now_, seconds);
  server_->publish(Channel::face,
                   {.bytes = write_unit({std::uint64_t(time), std::uint32_t(unit.duration),
                                         std::uint8_t(unit.intra ? kIntra : 0), unit.bytes}),
                    .entry = unit.intra,
                    .time = seconds});
  const auto face = values_.push(unit.bytes);
  std::string text;
  if (face) {
    const ValuesMessage message{seconds, double(unit.duration) / info_.timescale, unit.intra,
                                unit.bytes.size()};
    text = write_values(message, *face);
    server_->publish(
        Channel::faps,
        {.bytes = {text.begin(), text.end()}, .text = true, .entry = unit.intra, .time = seconds});
  }
  if (peers_) peers_->send(unit, text);
  if (unit.intra) {
    server_->forget_before(Channel::audio, seconds - kSoundBefore);
    describe();
  }
  ++face_units_;
  return {};
}

Result<void> Sink::send_sound(const LiveUnit& unit) {
  if (!info_.audio) return invalid("start() was not told of a sound");
  const std::int64_t time = unit.time + std::int64_t(info_.audio->sample_rate) * kWebTimeZero;
  if (time < 0) return invalid("a packet lies more than a second before time 0");
  if (peers_) peers_->send(unit, {});
  const bool follows = packets_.empty() || packets_.back().time + packets_.back().duration == time;
  if (!follows) {
    if (Result<void> flushed = flush(); !flushed) return flushed;
  }
  packets_.push_back({unit.bytes, time, unit.duration});
  ++audio_units_;
  if (packets_.size() < std::size_t(options_.packets_per_segment)) return {};
  return flush();
}

/// Publishes the segment that was being collected.
Result<void> Sink::flush() {
  if (packets_.empty()) return {};
  auto segment = media::write_audio_segment(++segments_, packets_);
  const double seconds = double(packets_.front().time) / info_.audio->sample_rate;
  packets_.clear();
  if (!segment) return segment.error();
  server_->publish(Channel::audio, {.bytes = std::move(*segment), .entry = true, .time = seconds});
  now_ = std::max(now_, seconds);
  if (info_.face_config.empty()) {
    server_->forget_before(Channel::audio, seconds - kSoundAlone);
    if (segments_ % 16 == 0) describe();
  }
  return {};
}

}  // namespace

bool is_open_to_others(const std::string& url) {
  const Result<WebAddress> address = parse_web_address(url);
  return address && listens_for_others(*address);
}

Result<std::unique_ptr<WebSink>> make_web_sink(const std::string& url, const WebOptions& options) {
  Result<WebAddress> address = parse_web_address(url);
  if (!address) return address.error();
  if (options.max_clients < 1 || options.max_clients > 1000) {
    return invalid("1 to 1000 clients can be served");
  }
  if (options.packets_per_segment < 1 || options.packets_per_segment > 64) {
    return invalid("a segment takes 1 to 64 packets of sound");
  }
  if (options.client_bytes < 4096 || !(options.stall_seconds > 0)) {
    return invalid("a client needs at least 4096 bytes and some patience");
  }
  if (options.head_script.empty() != options.head_model.empty()) {
    return invalid("a head for the page needs its script and its model");
  }
  if (options.per_address < 0) return invalid("connections of an address cannot be negative");
  for (const std::string& origin : options.allow_origins) {
    const bool known =
        origin == "*" || origin.starts_with("http://") || origin.starts_with("https://");
    const bool whole = origin.find('/', origin.find("//") + 2) == std::string::npos;
    if (!known || (origin != "*" && !whole) || !is_plain(origin)) {
      return make_error(Code::invalid_argument,
                        "'" + origin + "' is no origin; write it as https://example.org, or *");
    }
  }
  for (const std::string& name : options.host_names) {
    if (name.empty() || !is_plain(name) || name.find('/') != std::string::npos) {
      return make_error(
          Code::invalid_argument,
          "'" + name + "' is no name of a host; write it as example.org, without http://");
    }
  }
  return std::unique_ptr<WebSink>(new Sink(std::move(*address), options));
}

}  // namespace animeme::web
