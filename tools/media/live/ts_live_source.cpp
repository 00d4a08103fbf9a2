#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include "tools/media/detail/ffmpeg.h"
#include "tools/media/detail/net_stream.h"
#include "tools/media/detail/ts_events.h"
#include "tools/media/live/ts_live.h"

namespace animeme::media {
namespace {

using Clock = std::chrono::steady_clock;

/// A stream of so many bytes in which no program was found is none.
constexpr std::int64_t kEnoughToTell = std::int64_t(1) << 20;

class TsSource : public LiveSource {
 public:
  explicit TsSource(std::unique_ptr<NetReader> reader) : reader_(std::move(reader)) {}

  Result<LiveEvent> next(double seconds) override {
    return av::guarded([&]() -> Result<LiveEvent> {
      const auto until = Clock::now() + std::chrono::microseconds(
                                            std::int64_t(std::clamp(seconds, 0.0, 1e6) * 1e6));
      while (events_.empty()) {
        if (over_) return LiveEvent(LiveEnd{});
        auto datagram = reader_->next(until);
        if (!datagram) return LiveEvent(LiveIdle{});
        if (datagram->end) {
          if (!datagram->error.message.empty()) return datagram->error;
          over_ = true;
          parser_.finish(events_);
          break;
        }
        take(datagram->bytes);
        if (!program_found_ && demuxer_.stats().bytes > kEnoughToTell) {
          return make_error(Code::syntax,
                            "what comes in is no transport stream with a face or sound");
        }
      }
      Result<LiveEvent> event(std::move(events_.front()));
      events_.pop_front();
      return event;
    });
  }

  ReceiveStats stats() const override {
    ReceiveStats stats = demuxer_.stats();
    stats.jitter = jitter_;
    return stats;
  }

 private:
  void take(std::span<const std::uint8_t> bytes) {
    std::vector<TsEvent> found;
    demuxer_.push(bytes, found);
    for (TsEvent& event : found) {
      if (std::holds_alternative<TsMap>(event)) program_found_ = true;
      if (const auto* pes = std::get_if<TsPes>(&event)) measure(*pes);
      parser_.push(std::move(event), events_);
    }
  }

  /// RFC 3550, section 6.4.1.
  void measure(const TsPes& pes) {
    if (pes.track != LiveTrack::face || !pes.stamp) return;
    const double arrival = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    const double transit = arrival - double(*pes.stamp) / 90000;
    if (transit_ != 0) jitter_ += (std::min(std::abs(transit - transit_), 10.0) - jitter_) / 16;
    transit_ = transit;
  }

  std::unique_ptr<NetReader> reader_;
  TsDemuxer demuxer_;
  TsEvents parser_;
  std::deque<LiveEvent> events_;
  bool over_ = false, program_found_ = false;
  double jitter_ = 0, transit_ = 0;
};

}  // namespace

Result<std::unique_ptr<LiveSource>> make_ts_source(const std::string& url,
                                                   const TsOptions& options) {
  return av::guarded([&]() -> Result<std::unique_ptr<LiveSource>> {
    Result<NetAddress> address = parse_net_address(url, true);
    if (!address) return address.error();
    auto reader = std::make_unique<NetReader>(std::move(*address), options.queue_bytes);
    Result<void> started = reader->start();
    if (!started) return started.error();
    return std::unique_ptr<LiveSource>(new TsSource(std::move(reader)));
  });
}

}  // namespace animeme::media
