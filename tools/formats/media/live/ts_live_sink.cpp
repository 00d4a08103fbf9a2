#include <algorithm>

#include "tools/formats/media/detail/ffmpeg/net_stream.h"
#include "tools/formats/media/detail/ts/ts_muxer.h"
#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/live/ts_live.h"

namespace animeme::media {
namespace {

constexpr int kLastTables = 3;  // any of them may get lost

class TsSink : public LiveSink {
 public:
  TsSink(NetAddress address, const TsOptions& options)
      : address_(std::move(address)), options_(options) {}

  Result<void> start(const LiveInfo& info) override {
    return av::guarded([&]() -> Result<void> {
      if (muxer_ != nullptr) {
        return make_error(Code::invalid_argument, "the sink has been started already");
      }
      Result<std::unique_ptr<TsMuxer>> muxer = TsMuxer::open(info, options_.table_period);
      if (!muxer) return muxer.error();
      writer_ = std::make_unique<NetWriter>(address_, options_.queue_bytes, payload());
      Result<void> started = writer_->start();
      if (!started) return started;
      muxer_ = std::move(*muxer);
      return {};
    });
  }

  Result<void> send(const LiveUnit& unit) override {
    return av::guarded([&]() -> Result<void> {
      if (muxer_ == nullptr) return not_started();
      Result<std::vector<std::uint8_t>> packets = muxer_->write(unit);
      if (!packets) return packets.error();
      (unit.track == LiveTrack::face ? stats_.face_units : stats_.audio_units)++;
      if (!write(*packets)) ++stats_.dropped;
      return poll();
    });
  }

  Result<void> poll() override {
    if (writer_ == nullptr || !writer_->broken()) return {};
    return make_error(Code::io,
                      "the receiver at " + address_.text() + " has closed the connection");
  }

  Result<void> finish() override {
    return av::guarded([&]() -> Result<void> {
      if (writer_ == nullptr || muxer_ == nullptr) return {};
      for (int i = 0; i < kLastTables; ++i) {
        const auto packet = end_of_programs(unsigned(++table_counter_), 1);
        write(packet);
      }
      writer_->finish();
      muxer_.reset();
      return {};
    });
  }

  SendStats stats() const override {
    SendStats stats = stats_;
    const bool srt = address_.scheme == "srt";
    stats.receivers = srt && writer_ != nullptr && writer_->connected() ? 1 : 0;
    return stats;
  }

 private:
  int payload() const { return options_.datagram_bytes / int(kTsPacket) * int(kTsPacket); }

  static Error not_started() {
    return make_error(Code::invalid_argument, "the sink has not been started");
  }

  bool write(std::span<const std::uint8_t> packets) {
    for (std::size_t at = 0; at + kTsPacket <= packets.size(); at += kTsPacket) {
      const bool pat = (packets[at + 1] & 0x1F) == 0 && packets[at + 2] == 0;
      if (pat) table_counter_ = packets[at + 3] & 15;
    }
    while (!packets.empty()) {
      const auto datagram = packets.first(std::min(packets.size(), std::size_t(payload())));
      if (!writer_->write(datagram)) return false;
      stats_.packets += std::int64_t(datagram.size() / kTsPacket);
      stats_.bytes += std::int64_t(datagram.size());
      packets = packets.subspan(datagram.size());
    }
    return true;
  }

  const NetAddress address_;
  const TsOptions options_;
  std::unique_ptr<NetWriter> writer_;
  std::unique_ptr<TsMuxer> muxer_;
  int table_counter_ = 0;  // continuity of the PAT
  SendStats stats_;
};

}  // namespace

Result<std::unique_ptr<LiveSink>> make_ts_sink(const std::string& url, const TsOptions& options) {
  return av::guarded([&]() -> Result<std::unique_ptr<LiveSink>> {
    Result<NetAddress> address = parse_net_address(url, false);
    if (!address) return address.error();
    if (options.datagram_bytes < int(kTsPacket) || options.datagram_bytes > 1456) {
      return make_error(Code::invalid_argument, "a datagram takes 188 to 1456 bytes");
    }
    if (!(options.table_period >= 0.02 && options.table_period <= 0.5)) {
      return make_error(Code::invalid_argument, "the tables come every 0.02 to 0.5 seconds");
    }
    return std::unique_ptr<LiveSink>(new TsSink(std::move(*address), options));
  });
}

}  // namespace animeme::media
