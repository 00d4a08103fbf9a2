#include <algorithm>
#include <chrono>
#include <deque>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ffmpeg/net_stream.h"
#include "tools/formats/media/detail/ts/ts_input.h"
#include "tools/formats/media/live/ts_live.h"

namespace animeme::media {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// A connection that has brought so many bytes without a program is none of ours.
constexpr std::int64_t kEnoughToTell = std::int64_t(1) << 20;

class TsSource : public LiveSource {
 public:
  /// `connection`: all bytes come from one sender; not a transport stream: an error.
  TsSource(std::unique_ptr<NetReader> reader, bool connection, bool any_source)
      : reader_(std::move(reader)), connection_(connection), input_(any_source) {}

  Result<LiveEvent> next(double seconds) override {
    return av::guarded([&]() -> Result<LiveEvent> {
      const auto until =
          SteadyClock::now() +
          std::chrono::microseconds(std::int64_t(std::clamp(seconds, 0.0, 1e6) * 1e6));
      while (events_.empty()) {
        if (over_) return LiveEvent(LiveEnd{});
        auto datagram = reader_->next(until);
        if (!datagram) return LiveEvent(LiveIdle{});
        if (datagram->end) {
          if (!datagram->error.message.empty()) return datagram->error;
          over_ = true;
          input_.finish(events_);
          break;
        }
        bytes_ += std::int64_t(datagram->bytes.size());
        input_.push(datagram->bytes, datagram->from, seconds_now(), events_);
        if (connection_ && !input_.found() && bytes_ > kEnoughToTell) {
          return make_error(Code::syntax,
                            "the received data is not a transport stream with a face or sound");
        }
      }
      Result<LiveEvent> event(std::move(events_.front()));
      events_.pop_front();
      return event;
    });
  }

  ReceiveStats stats() const override { return input_.stats(); }

 private:
  static double seconds_now() {
    return std::chrono::duration<double>(SteadyClock::now().time_since_epoch()).count();
  }

  std::unique_ptr<NetReader> reader_;
  const bool connection_;
  TsInput input_;
  std::int64_t bytes_ = 0;
  std::deque<LiveEvent> events_;
  bool over_ = false;
};

}  // namespace

Result<std::unique_ptr<LiveSource>> make_ts_source(const std::string& url,
                                                   const TsOptions& options) {
  return av::guarded([&]() -> Result<std::unique_ptr<LiveSource>> {
    Result<NetAddress> address = parse_net_address(url, true);
    if (!address) return address.error();
    const bool connection = address->scheme != "udp";
    auto reader = std::make_unique<NetReader>(std::move(*address), options.queue_bytes);
    Result<void> started = reader->start();
    if (!started) return started.error();
    return std::unique_ptr<LiveSource>(
        new TsSource(std::move(reader), connection, options.any_source));
  });
}

}  // namespace animeme::media
