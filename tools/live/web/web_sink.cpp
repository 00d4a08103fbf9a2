#include <algorithm>
#include <exception>
#include <initializer_list>

#include "tools/formats/common/json.h"
#include "tools/formats/media/detail/tracks/words_internal.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/live/web/detail/headers.h"
#include "tools/live/web/detail/messages.h"
#include "tools/live/web/detail/planes.h"
#include "tools/live/web/detail/server.h"
#include "tools/live/web/detail/values.h"
#include "tools/live/web/web.h"
#include "tools/live/web/web_server.h"

namespace animeme::web {
namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr double kSoundBefore = 0.25;  // seconds of it that newcomers get before the face
constexpr double kSoundAlone = 1;      // the same where there is no face

Error invalid(const std::string& what) { return make_error(Code::invalid_argument, what); }

bool is_plain(const std::string& text) {
  // What separates in headers is in no name and no origin.
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return c > ' ' && c <= '~' && c != ';' && c != ','; });
}

template <class Body>
auto guarded(const Body& body) -> decltype(body()) {
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
  /// On a shared server, below `path`.
  Sink(WebAddress address, const WebOptions& options, std::shared_ptr<Server> server,
       std::string path, std::function<void()> joined, std::string head)
      : address_(std::move(address)),
        options_(options),
        shared_server_(std::move(server)),
        path_(std::move(path)),
        joined_(std::move(joined)),
        head_(std::move(head)) {}
  ~Sink() override {
    if (peer_connections_) peer_connections_->finish(true);  // they answer no more
    // Once it is over, its path may be that of another one.
    if (shared_server_ && broadcast_ && !over_) shared_server_->close(path_);
  }

  Result<void> start(const media::LiveInfo& info) override {
    return guarded([&] { return begin(info); });
  }
  Result<void> send(const LiveUnit& unit) override {
    return guarded([&]() -> Result<void> {
      if (!broadcast_ || over_) return invalid("the sink is not running");
      return unit.track == LiveTrack::face ? send_face(unit) : send_sound(unit);
    });
  }
  Result<void> tell(const std::string& json) override {
    return guarded([&]() -> Result<void> {
      if (!broadcast_ || over_) return invalid("the sink is not running");
      return publish_note(json, {Channel::face, Channel::faps, Channel::planes});
    });
  }
  Result<void> tell_owner(const std::string& json) override {
    return guarded([&]() -> Result<void> {
      if (!broadcast_ || over_) return invalid("the sink is not running");
      return publish_note(json, {Channel::owner});
    });
  }
  Result<void> poll() override { return {}; }
  Result<void> finish() override { return end(false); }
  Result<void> leave() override { return end(true); }

  media::SendStats stats() const override {
    media::SendStats stats = broadcast_ ? broadcast_->stats() : media::SendStats{};
    if (server_) stats.receivers = server_->viewers();
    if (peer_connections_) {
      const media::SendStats more = peer_connections_->stats();
      // Of many heads, one that nobody watches sleeps; viewers need it to connect.
      stats.receivers += server_ ? more.receivers : peer_connections_->busy();
      stats.packets += more.packets;
      stats.bytes += more.bytes;
      stats.dropped += more.dropped;
      stats.repeated += more.repeated;
      stats.reported_loss = more.reported_loss;
      stats.sound_loss = more.sound_loss;
    }
    stats.face_units = face_units_;
    stats.audio_units = audio_units_;
    return stats;
  }

  std::string address() const override {
    if (!broadcast_) return {};
    const int port = shared_server_ ? shared_server_->port() : server_->port();
    const std::string text = WebAddress{address_.host, port}.text();
    return shared_server_ ? text + path_.substr(1) + "/" : text;
  }

 private:
  Result<void> end(bool comes_back) {
    return guarded([&]() -> Result<void> {
      if (!broadcast_ || over_) return {};
      Result<void> flushed = flush();
      over_ = true;
      if (shared_server_) {
        shared_server_->close(path_, comes_back);
      } else {
        server_->finish(comes_back);
      }
      if (peer_connections_) peer_connections_->finish(!comes_back);
      return flushed;
    });
  }

  Result<void> begin(const media::LiveInfo& info);
  Result<void> send_face(const LiveUnit& unit);
  void send_values(const LiveUnit& unit);
  Result<void> send_sound(const LiveUnit& unit);
  Result<void> publish_note(const std::string& json, std::initializer_list<Channel> channels);
  Result<void> flush();
  void describe();

  const WebAddress address_;
  const WebOptions options_;
  media::LiveInfo info_;
  const std::shared_ptr<Server> shared_server_;  // null: the sink has its own server
  const std::string path_;
  const std::function<void()> joined_;
  const std::string head_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<Broadcast> broadcast_;
  std::shared_ptr<PeerConnections> peer_connections_;  // null: no WebRTC
  bool over_ = false;
  struct Decoded {
    Values values;
    PlaneWriter planes;
  };
  std::unique_ptr<Decoded> decoded_;         // while somebody wants it
  std::vector<LiveUnit> unread_;             // since the last intra plane; not decoded
  std::vector<media::AudioPacket> packets_;  // of the next segment
  std::uint32_t segments_ = 0;
  double now_ = 0;  // on the clock of the segments
  std::int64_t face_units_ = 0, audio_units_ = 0;
};

Result<void> Sink::begin(const media::LiveInfo& info) {
  if (broadcast_) return invalid("the sink has been started already");
  if (info.face_config.empty() && !info.audio) return invalid("there is neither face nor sound");
  if (info.timescale == 0) return invalid("the time scale is 0");
  info_ = info;
  std::vector<std::uint8_t> init;
  if (info_.audio) {
    Result<std::vector<std::uint8_t>> written = media::write_audio_init(*info_.audio);
    if (!written) return written.error();
    init = std::move(*written);
  }
  if (!shared_server_) {
    auto server = Server::listen(address_, {options_}, nullptr);
    if (!server) return server.error();
    server_ = std::move(*server);
  }
  Server& server = shared_server_ ? *shared_server_ : *server_;
  broadcast_ = server.make_broadcast(info_.audio ? info_.audio->sample_rate : 0, joined_);
  const Hello hello{info_.visual_profile, info_.audio.has_value(), info_.timescale,
                    info_.face_config};
  broadcast_->set_hello(Channel::face, {.bytes = write_hello(hello)});
  const std::string names = values_hello(info_.timescale);
  for (const Channel channel : {Channel::faps, Channel::planes}) {
    broadcast_->set_hello(channel, {.bytes = {names.begin(), names.end()}, .text = true});
  }
  if (!init.empty()) broadcast_->set_hello(Channel::audio, {.bytes = std::move(init)});
  if (options_.make_peer_connections) {
    peer_connections_ = options_.make_peer_connections();
    Result<void> ready =
        peer_connections_->start(info_, options_.max_clients, options_.per_address);
    if (!ready && options_.must_have_peer_connections) return ready;
    if (!ready) peer_connections_.reset();
    broadcast_->set_peers(peer_connections_);
  }
  describe();
  if (!server.open(path_, broadcast_)) {
    broadcast_.reset();
    return invalid("another presentation has this path");
  }
  if (server_) server_->serve();
  return {};
}

/// /info.json
void Sink::describe() {
  tools::Json json{{"version", kVersion}, {"time_zero", kWebTimeZero}, {"now", now_}};
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
  if (!options_.other_heads.empty()) {
    json["heads"] = {options_.head_name};
    for (const WebHead& head : options_.other_heads) json["heads"].push_back(head.name);
  }
  if (!head_.empty()) json["head"] = head_;
  if (peer_connections_) json["webrtc"] = true;  // at /whep
  json["clients"] = stats().receivers;
  // Names of heads may be any text.
  broadcast_->set_info(json.dump());
}

Result<void> Sink::send_face(const LiveUnit& unit) {
  if (info_.face_config.empty()) return invalid("start() was called without a face");
  const std::int64_t time = unit.time + std::int64_t(info_.timescale) * kWebTimeZero;
  if (time < 0) return invalid("a unit is more than a second before time 0");
  if (unit.duration < 0 || unit.duration > UINT32_MAX || unit.bytes.empty()) {
    return invalid("a unit is empty or its duration does not fit in 32 bits");
  }
  const double seconds = double(time) / info_.timescale;
  now_ = std::max(now_, seconds);
  broadcast_->publish(Channel::face,
                      {.bytes = write_unit({std::uint64_t(time), std::uint32_t(unit.duration),
                                            std::uint8_t(unit.intra ? kIntra : 0), unit.bytes}),
                       .entry = unit.intra,
                       .time = seconds});
  send_values(unit);
  if (unit.intra) {
    broadcast_->forget_before(Channel::audio, seconds - kSoundBefore);
    describe();
  }
  ++face_units_;
  return {};
}

/// What nobody looks at is not decoded on a shared server: it may have hundreds of faces. Who comes
/// then gets, with the next plane, all since the last intra plane.
void Sink::send_values(const LiveUnit& unit) {
  if (shared_server_ && unit.intra) unread_.clear();
  const bool wanted = broadcast_->wanted(Channel::faps) || broadcast_->wanted(Channel::planes) ||
                      (peer_connections_ && peer_connections_->busy() > 0);
  if (shared_server_ && !wanted) {
    if (unit.intra || !unread_.empty()) unread_.push_back(unit);
    if (decoded_) {
      broadcast_->forget(Channel::faps);
      broadcast_->forget(Channel::planes);
    }
    decoded_.reset();
    return;
  }
  if (!decoded_) decoded_ = std::make_unique<Decoded>();
  unread_.push_back(unit);
  for (const LiveUnit& next : std::exchange(unread_, {})) {
    const auto face = decoded_->values.push(next.bytes);
    std::string text;
    if (face) {
      const std::int64_t time = next.time + std::int64_t(info_.timescale) * kWebTimeZero;
      const double seconds = double(time) / info_.timescale;
      text = write_values(
          {seconds, double(next.duration) / info_.timescale, next.intra, next.bytes.size()}, *face);
      broadcast_->publish(Channel::faps, {.bytes = {text.begin(), text.end()},
                                          .text = true,
                                          .entry = next.intra,
                                          .time = seconds});
      const PlaneWriter::Plane plane{std::uint64_t(time), std::uint32_t(next.duration), next.intra,
                                     next.bytes.size()};
      broadcast_->publish(
          Channel::planes,
          {.bytes = decoded_->planes.write(plane, *face), .entry = next.intra, .time = seconds});
    }
    if (peer_connections_) peer_connections_->send(next, text);
  }
}

Result<void> Sink::send_sound(const LiveUnit& unit) {
  if (!info_.audio) return invalid("start() was called without sound");
  const std::int64_t time = unit.time + std::int64_t(info_.audio->sample_rate) * kWebTimeZero;
  if (time < 0) return invalid("a packet is more than a second before time 0");
  if (peer_connections_ && (server_ || peer_connections_->busy() > 0)) {
    peer_connections_->send(unit, {});
  }
  const bool follows = packets_.empty() || packets_.back().time + packets_.back().duration == time;
  if (!follows) {
    if (Result<void> flushed = flush(); !flushed) return flushed;
  }
  packets_.push_back({unit.bytes, time, unit.duration});
  ++audio_units_;
  if (packets_.size() < std::size_t(options_.packets_per_segment)) return {};
  return flush();
}

/// To the sockets of some channels, between the frames.
Result<void> Sink::publish_note(const std::string& json, std::initializer_list<Channel> channels) {
  Result<tools::Json> note = tools::Json::parse(json);
  if (!note || !note->is_object()) return invalid("an event must be a JSON object");
  if (const tools::Json* time = note->find("time"); time != nullptr && time->is_number()) {
    (*note)["time"] = time->get<double>() + kWebTimeZero;
  }
  const std::string text = note->dump();
  for (const Channel channel : channels) {
    broadcast_->publish(channel, {.bytes = {text.begin(), text.end()}, .text = true, .time = now_});
    if (channel == Channel::faps && peer_connections_) peer_connections_->tell(text);
  }
  return {};
}

/// Publishes the segment that was being collected.
Result<void> Sink::flush() {
  if (packets_.empty()) return {};
  auto segment = media::write_audio_segment(++segments_, packets_);
  const double seconds = double(packets_.front().time) / info_.audio->sample_rate;
  packets_.clear();
  if (!segment) return segment.error();
  broadcast_->publish(Channel::audio,
                      {.bytes = std::move(*segment), .entry = true, .time = seconds});
  now_ = std::max(now_, seconds);
  if (info_.face_config.empty()) {
    broadcast_->forget_before(Channel::audio, seconds - kSoundAlone);
    if (segments_ % 16 == 0) describe();
  }
  return {};
}

Result<void> check(const WebOptions& options, int most_clients) {
  if (options.max_clients < 1 || options.max_clients > most_clients) {
    return invalid("1 to " + std::to_string(most_clients) + " clients can be served");
  }
  if (options.packets_per_segment < 1 || options.packets_per_segment > 64) {
    return invalid("a segment has 1 to 64 packets of sound");
  }
  if (options.client_bytes < 4096 || !(options.stall_seconds > 0)) {
    return invalid("a client needs at least 4096 bytes and some patience");
  }
  const auto has_none = [](const WebHead& head) { return head.model.empty(); };
  const bool has_head = !options.head_model.empty() || options.make_head_model;
  if (options.head_script.empty() == has_head ||
      (options.head_script.empty() && !options.other_heads.empty()) ||
      std::any_of(options.other_heads.begin(), options.other_heads.end(), has_none)) {
    return invalid("a head for the page needs its script and its model");
  }
  if (options.per_address < 0) return invalid("connections of an address cannot be negative");
  for (const std::string& origin : options.allow_origins) {
    const bool known =
        origin == "*" || origin.starts_with("http://") || origin.starts_with("https://");
    const bool whole = origin.find('/', origin.find("//") + 2) == std::string::npos;
    if (!known || (origin != "*" && !whole) || !is_plain(origin)) {
      return make_error(Code::invalid_argument,
                        "'" + origin + "' is not an origin; write it as https://example.org, or *");
    }
  }
  for (const std::string& name : options.host_names) {
    if (name.empty() || !is_plain(name) || name.find('/') != std::string::npos) {
      return make_error(
          Code::invalid_argument,
          "'" + name + "' is not a host name; write it as example.org, without http://");
    }
  }
  return {};
}

class SharedServer : public WebServer {
 public:
  SharedServer(std::shared_ptr<Server> server, WebAddress address, WebOptions options)
      : server_(std::move(server)), address_(std::move(address)), options_(std::move(options)) {
    address_.port = server_->port();
    options_.head_script.clear();  // the server has them
    options_.head_model.clear();
    options_.make_head_model = nullptr;
    for (WebHead& head : options_.other_heads) head.model.clear();  // pages get their names only
  }
  std::string address() const override { return address_.text(); }
  std::unique_ptr<WebSink> make_sink(const std::string& path, std::function<void()> joined,
                                     const std::string& head) override {
    return std::make_unique<Sink>(address_, options_, server_, path, std::move(joined), head);
  }
  int viewers() const override { return server_->viewers(); }
  void finish() override { server_->finish(true); }

 private:
  std::shared_ptr<Server> server_;
  WebAddress address_;
  WebOptions options_;
};

}  // namespace

bool is_open_to_others(const std::string& url) {
  const Result<WebAddress> address = parse_web_address(url);
  return address && listens_for_others(*address);
}

Result<std::unique_ptr<WebSink>> make_web_sink(const std::string& url, const WebOptions& options) {
  Result<WebAddress> address = parse_web_address(url);
  if (!address) return address.error();
  if (auto ok = check(options, 1000); !ok) return ok.error();
  return std::unique_ptr<WebSink>(new Sink(std::move(*address), options));
}

Result<std::unique_ptr<WebServer>> WebServer::open(const std::string& url,
                                                   const ServerOptions& options,
                                                   ServerHandler handler) {
  return guarded([&]() -> Result<std::unique_ptr<WebServer>> {
    Result<WebAddress> address = parse_web_address(url);
    if (!address) return address.error();
    if (auto ok = check(options.web, 10000); !ok) return ok.error();
    auto server = Server::listen(*address, options, std::move(handler));
    if (!server) return server.error();
    (*server)->serve();
    return std::unique_ptr<WebServer>(
        new SharedServer(std::move(*server), std::move(*address), options.web));
  });
}

}  // namespace animeme::web
