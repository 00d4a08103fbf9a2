// Publishing to a server of WHIP. Source: RFC 9725, sections 4.2 to 4.4.
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "tools/live/webrtc/detail/feed.h"
#include "tools/live/webrtc/detail/load.h"
#include "tools/live/webrtc/detail/where.h"

namespace animeme::webrtc {
namespace {

constexpr std::chrono::seconds kServerPatience{10};
constexpr std::chrono::milliseconds kEndAgain{60};
constexpr int kOwnRedundant = 63;  // payload type of our offer, as browsers have it

class WhipSink : public media::LiveSink {
 public:
  WhipSink(Where where, std::string token) : where_(std::move(where)), token_(std::move(token)) {}
  ~WhipSink() override { leave(); }

  Result<void> start(const media::LiveInfo& info) override;
  Result<void> send(const media::LiveUnit& unit) override;
  Result<void> poll() override { return check(); }
  Result<void> finish() override;
  media::SendStats stats() const override;

 private:
  /// Our offer, handed over by the connection's thread.
  struct Offered {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::string sdp, problem;
  };
  Result<void> check();
  void leave();

  const Where where_;
  const std::string token_;
  const Functions* module_ = nullptr;
  std::optional<Feed> feed_;
  Receiver receiver_;
  std::string resource_;  // what the server made of it
  bool connected_ = false;
  std::int64_t face_units_ = 0, audio_units_ = 0;
};

Result<void> WhipSink::start(const media::LiveInfo& info) {
  if (feed_) return make_error(Code::invalid_argument, "the sink has been started already");
  if (info.face_config.empty() && !info.audio) {
    return make_error(Code::invalid_argument, "there is neither face nor sound");
  }
  Result<Feed> feed = Feed::make(info, where_.options);
  if (!feed) return feed.error();
  Result<const Functions*> module = functions();
  if (!module) return module.error();
  module_ = *module;
  feed_.emplace(std::move(*feed));
  PeerSettings settings;
  settings.sound = info.audio.has_value();
  settings.stun = where_.options.stun;
  settings.turn = where_.options.turn;
  if (settings.sound && where_.options.audio_repeat != 0) settings.redundant = kOwnRedundant;
  if (!info.face_config.empty()) settings.channels = {kFace};
  const auto offered = std::make_shared<Offered>();
  receiver_.peer =
      module_->open(settings, [offered](const std::string& sdp, const std::string& problem) {
        const std::lock_guard lock(offered->mutex);
        offered->sdp = sdp;
        offered->problem = problem;
        offered->done = true;
        offered->changed.notify_all();
      });
  std::unique_lock lock(offered->mutex);
  if (!offered->changed.wait_for(lock, kServerPatience, [&] { return offered->done; })) {
    return make_error(Code::io, "no candidates were found; is the STUN or TURN server there?");
  }
  if (!offered->problem.empty()) return make_error(Code::io, offered->problem);
  SoundTypes own = sound_types(offered->sdp);
  if (settings.redundant >= 0) own.redundant = settings.redundant;
  const HttpAnswer answer =
      module_->exchange({"POST", where_.address, token_, with_redundant(offered->sdp, own),
                         double(kServerPatience.count())});
  if (!answer.problem.empty()) {
    return make_error(Code::io, "the server does not answer: " + answer.problem);
  }
  if (answer.status != 201) {
    return make_error(Code::io, "the server refuses with " + std::to_string(answer.status) +
                                    (answer.status == 401 || answer.status == 403
                                         ? "; does it need a token (whip://TOKEN@HOST/...)?"
                                         : ": " + answer.body.substr(0, 200)));
  }
  resource_ = answer.location;
  receiver_.types = sound_types(answer.body);
  receiver_.peer->answered(without_redundant(answer.body, receiver_.types));
  return {};
}

Result<void> WhipSink::check() {
  if (!receiver_.peer) return make_error(Code::invalid_argument, "the sink is not running");
  const Peer::State state = receiver_.peer->state();
  connected_ = state == Peer::State::connected;
  if (state != Peer::State::over) return {};
  const std::string why = receiver_.peer->problem();
  return make_error(Code::io, why.empty() ? "the server has closed the connection" : why);
}

Result<void> WhipSink::send(const media::LiveUnit& unit) {
  if (Result<void> good = check(); !good) return good;
  feed_->push(unit, {});
  if (connected_) feed_->give(receiver_);
  ++(unit.track == media::LiveTrack::face ? face_units_ : audio_units_);
  return {};
}

Result<void> WhipSink::finish() {
  if (!receiver_.peer) return {};
  for (int i = 0; i < 3 && connected_; ++i) {
    feed_->end(receiver_);
    std::this_thread::sleep_for(kEndAgain);
  }
  leave();
  return {};
}

void WhipSink::leave() {
  if (!receiver_.peer) return;
  receiver_.peer->goodbye();
  if (!resource_.empty()) module_->exchange({"DELETE", resource_, token_, "", 3});
  receiver_.peer.reset();
  connected_ = false;
}

media::SendStats WhipSink::stats() const {
  media::SendStats stats = feed_ ? feed_->stats() : media::SendStats{};
  stats.face_units = face_units_;
  stats.audio_units = audio_units_;
  stats.receivers = connected_ ? 1 : 0;
  if (connected_) {
    stats.reported_loss = receiver_.loss;
    stats.sound_loss = feed_->needs_fec(receiver_);
  }
  return stats;
}

}  // namespace

Result<std::unique_ptr<media::LiveSink>> make_whip_sink(const std::string& url) {
  Result<Where> where = parse_where(url);
  if (!where) return where.error();
  const std::size_t begin = where->address.find("://") + 3;
  std::string host = where->address.substr(begin), token;
  const std::size_t at = host.substr(0, host.find('/')).rfind('@');
  if (at != host.npos) {
    token = host.substr(0, at);
    host.erase(0, at + 1);
  } else if (const char* given = std::getenv("ANIMEME_WHIP_TOKEN")) {
    token = given;
  }
  if (host.empty() || host.front() == '/' || token.find_first_of("\r\n") != token.npos) {
    return make_error(Code::invalid_argument,
                      "'" + url + "' names no server; write whip://HOST:PORT/PATH, or whips://");
  }
  where->address = (url.starts_with("whips") ? "https://" : "http://") + host;
  return std::unique_ptr<media::LiveSink>(new WhipSink(std::move(*where), std::move(token)));
}

}  // namespace animeme::webrtc
