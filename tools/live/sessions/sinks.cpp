#include "tools/live/sessions/sinks.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/live/webrtc/webrtc.h"

namespace animeme::live {

Result<Sinks> Sinks::open(const std::vector<std::string>& urls, const std::vector<std::string>& sdp,
                          const SinkOptions& options, const tools::Log& log) {
  Sinks sinks;
  sinks.log_ = log;
  std::size_t described = 0;
  for (const std::string& url : urls) {
    SinkOptions own = options;
    own.media.rtp.sdp_path.clear();
    if (is_rtp(url) && described < sdp.size()) own.media.rtp.sdp_path = sdp[described++];
    auto sink = open_sink(url, own);
    if (!sink) return sink.error().in_file(url);
    sinks.addresses_.push_back({url, std::move(*sink), false});
  }
  return sinks;
}

template <class Act>
Result<void> Sinks::each(Act act) {
  std::optional<Error> last;
  bool alive = false;
  for (Address& address : addresses_) {
    if (address.broken) continue;
    auto done = act(*address.sink);
    if (done) {
      alive = true;
      continue;
    }
    address.broken = true;
    if (last) log_.warn(last->describe() + "; it is not used any more");
    last = done.error().in_file(address.url);
  }
  if (!last) return {};
  if (!alive) return *last;
  log_.warn(last->describe() + "; it is not used any more");
  return {};
}

Result<void> Sinks::start(const media::LiveInfo& info) {
  for (Address& address : addresses_) {
    if (auto ok = address.sink->start(info); !ok) return ok.error().in_file(address.url);
    if (!web::is_open_to_others(webrtc::page_of(address.url))) continue;
    log_.warn(address.url +
              " is open to every machine that can reach this one: the page, the values and the "
              "sound, without a password. use http://127.0.0.1:PORT for this machine only, with a "
              "proxy that asks for a password if necessary");
  }
  return {};
}

Result<void> Sinks::send(const media::LiveUnit& unit) {
  if (unit.track != media::LiveTrack::face) {
    return each([&](media::LiveSink& sink) { return sink.send(unit); });
  }
  bool wanted = false;
  for (const Address& address : addresses_) {
    if (!address.broken && address.sink->intra_wanted()) wanted = true;
  }
  std::optional<fba::RecodedUnit> recoded = face_.pass(unit.bytes, wanted);
  if (!recoded) return each([&](media::LiveSink& sink) { return sink.send(unit); });
  media::LiveUnit own = unit;
  own.bytes = std::move(recoded->bytes);
  own.intra = recoded->intra;
  return each([&](media::LiveSink& sink) { return sink.send(own); });
}

Result<void> Sinks::tell(const std::string& json) {
  return each([&](media::LiveSink& sink) { return sink.tell(json); });
}

Result<void> Sinks::poll() {
  return each([](media::LiveSink& sink) { return sink.poll(); });
}

Result<void> Sinks::finish() {
  std::optional<Error> first;
  for (Address& address : addresses_) {
    if (address.broken) continue;
    if (auto done = address.sink->finish(); !done && !first) {
      first = done.error().in_file(address.url);
    }
  }
  if (first) return *first;
  return {};
}

media::SendStats Sinks::stats() const {
  media::SendStats sum;
  for (const Address& address : addresses_) {
    const media::SendStats one = address.sink->stats();
    sum.face_units = std::max(sum.face_units, one.face_units);
    sum.audio_units = std::max(sum.audio_units, one.audio_units);
    sum.packets += one.packets;
    sum.bytes += one.bytes;
    sum.repeated += one.repeated;
    sum.receivers += one.receivers;
    sum.dropped += one.dropped;
    sum.reported_loss = std::max(sum.reported_loss, one.reported_loss);
    sum.sound_loss = std::max(sum.sound_loss, one.sound_loss);
  }
  return sum;
}

}  // namespace animeme::live
