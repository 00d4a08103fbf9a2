#include "tools/live/sessions/relay.h"

#include <utility>

namespace animeme::live {

Result<Relay> Relay::open(const std::vector<std::string>& urls, const std::vector<std::string>& sdp,
                          const tools::Log& log) {
  auto sinks = Sinks::open(urls, sdp, {}, log);
  if (!sinks) return sinks.error();
  Relay relay;
  relay.sinks_ = std::move(*sinks);
  return relay;
}

Result<void> Relay::send(const media::LiveInfo& info, const media::LiveUnit& unit) {
  if (!wanted()) return {};
  if (!std::exchange(started_, true)) {
    if (auto ok = sinks_.start(info); !ok) return ok;
  }
  return sinks_.send(unit);
}

Result<void> Relay::poll() { return started_ ? sinks_.poll() : Result<void>(); }

Result<void> Relay::finish() { return started_ ? sinks_.finish() : Result<void>(); }

}  // namespace animeme::live
