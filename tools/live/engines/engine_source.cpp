#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

#include "tools/formats/media/live/pacer.h"
#include "tools/live/engines/detail/engine_input.h"
#include "tools/live/engines/engines.h"

namespace animeme::engines {
namespace {

using media::LiveEvent;

class EngineSource : public media::LiveSource {
 public:
  EngineSource(media::UdpSocket socket, const EngineAddress& address,
               const EngineSourceOptions& options)
      : socket_(std::move(socket)), input_(address, options) {}

  Result<LiveEvent> next(double seconds) override {
    media::Clock& clock = media::steady_clock();
    const double until = clock.now() + std::max(0.0, seconds);
    while (events_.empty()) {
      if (auto ok = input_.tick(clock.now(), events_); !ok) return ok.error();
      if (!events_.empty()) break;
      const double left = until - clock.now();
      const double wait = std::min(left, input_.patience(clock.now()).value_or(left));
      const media::UdpSocket* socket = &socket_;
      const auto ready = media::wait_for_any({&socket, 1}, std::max(0.0, wait));
      if (!ready) return ready.error();
      if (*ready) {
        if (auto ok = take(); !ok) return ok.error();
      } else if (clock.now() >= until) {
        return LiveEvent(media::LiveIdle{});
      }
    }
    LiveEvent event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

  media::ReceiveStats stats() const override { return input_.stats(); }

 private:
  // One at a time, each with the time of its own arrival.
  Result<void> take() {
    media::UdpAddress from;
    auto got = socket_.receive(&from);
    if (!got) return got.error();
    if (!*got) return {};
    return input_.push(**got, from, media::steady_clock().now(), events_);
  }

  media::UdpSocket socket_;
  EngineInput input_;
  std::deque<LiveEvent> events_;
};

}  // namespace

Result<std::unique_ptr<media::LiveSource>> make_engine_source(const std::string& url,
                                                              const EngineSourceOptions& options) {
  auto address = parse_engine_address(url, true);
  if (!address) return address.error();
  if (!(options.intra_seconds > 0)) {
    return make_error(Code::invalid_argument, "intra planes come every so many seconds, above 0");
  }
  auto socket = media::UdpSocket::bind(address->host, address->port);
  if (!socket) return socket.error();
  return std::unique_ptr<media::LiveSource>(
      new EngineSource(std::move(*socket), *address, options));
}

}  // namespace animeme::engines
