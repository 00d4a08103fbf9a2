#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ffmpeg/net_stream.h"
#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/ts/ts_pmt.h"
#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/live/live.h"
#include "tools/formats/media/live/ts_live.h"

namespace animeme::media {

namespace {

class TsMuxer {
 public:
  // `table_period`: seconds between PAT and PMT. Errors: invalid_argument (nothing to send, not
  // the configuration of a face), unsupported (sound that TS cannot carry).
  static Result<std::unique_ptr<TsMuxer>> open(const LiveInfo& info, double table_period);
  ~TsMuxer();
  TsMuxer(const TsMuxer&) = delete;
  TsMuxer& operator=(const TsMuxer&) = delete;

  // Transport packets of this unit, tables in front of it when they are due. Errors:
  // invalid_argument (no such track, too early, times that do not ascend).
  Result<std::vector<std::uint8_t>> write(const LiveUnit& unit);

 private:
  TsMuxer() = default;
  Result<void> start(double table_period);
  Result<void> add_face();
  Result<void> add_sound();
  static int collect(void* self, std::uint8_t* bytes, int size);

  LiveInfo info_;
  ProgramMapFilter program_map_{0x61};
  std::vector<std::uint8_t> bytes_;
  AVFormatContext* context_ = nullptr;
  av::Io io_;
  AVStream* streams_[2] = {nullptr, nullptr};  // by LiveTrack
  std::int64_t last_[2] = {INT64_MIN, INT64_MIN};
  av::Packet packet_;
};

// What decoders have between the clock of the stream and the time to show (libavformat doubles it
// in the stamps). Nothing waits for it here.
constexpr std::int64_t kMaxDelay = 100000;                       // microseconds
constexpr std::int64_t kAddedByMuxer = 2 * kMaxDelay * 9 / 100;  // ticks of 90 kHz
constexpr AVRational kStampBase{1, 90000};

int TsMuxer::collect(void* self, std::uint8_t* bytes, int size) {
  auto& target = static_cast<TsMuxer*>(self)->bytes_;
  try {
    target.insert(target.end(), bytes, bytes + size);
  } catch (...) {  // an exception must not go through C code
    return AVERROR(ENOMEM);
  }
  return size;
}

Result<std::unique_ptr<TsMuxer>> TsMuxer::open(const LiveInfo& info, double table_period) {
  std::unique_ptr<TsMuxer> muxer(new TsMuxer);
  muxer->info_ = info;
  muxer->program_map_ = ProgramMapFilter(info.visual_profile);
  Result<void> started = muxer->start(table_period);
  if (!started) return started.error();
  return muxer;
}

Result<void> TsMuxer::start(double table_period) {
  if (info_.face_config.empty() && !info_.audio) {
    return make_error(Code::invalid_argument, "there is neither a face nor a sound to send");
  }
  av::LogCapture log;
  packet_.reset(av_packet_alloc());
  avformat_alloc_output_context2(&context_, nullptr, "mpegts", nullptr);
  io_ = av::make_io(this, nullptr, &TsMuxer::collect, nullptr);
  if (!packet_ || context_ == nullptr || !io_) return av::no_memory();
  context_->pb = io_.get();
  context_->flags |= AVFMT_FLAG_BITEXACT | AVFMT_FLAG_CUSTOM_IO;
  context_->max_delay = int(kMaxDelay);
  context_->avoid_negative_ts = 0;
  if (!info_.face_config.empty()) {
    if (Result<void> added = add_face(); !added) return added;
  }
  if (info_.audio) {
    if (Result<void> added = add_sound(); !added) return added;
  }
  av::Options options;
  options.set("omit_video_pes_length", std::int64_t(0));  // the end of a unit is known at once
  options.set("pat_period", std::to_string(table_period));
  options.set("sdt_period", "1");
  const int status = avformat_write_header(context_, options.get());
  if (status < 0) {
    return make_error(Code::unsupported,
                      "a transport stream cannot carry this: " + av::error_text(status));
  }
  if (const char* name = options.unused()) {
    return make_error(Code::internal, std::string("this FFmpeg does not know the option ") + name);
  }
  return {};
}

Result<void> TsMuxer::add_face() {
  if (read_visual_headers(info_.face_config).kind != VisualKind::face || info_.timescale == 0) {
    return make_error(Code::invalid_argument, "the configuration is not that of a face");
  }
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  AVCodecParameters& parameters = *stream->codecpar;
  parameters.codec_type = AVMEDIA_TYPE_VIDEO;
  parameters.codec_id = AV_CODEC_ID_MPEG4;
  parameters.width = 320;
  parameters.height = 240;
  if (!av::set_extradata(parameters, info_.face_config)) return av::no_memory();
  stream->time_base = kStampBase;
  streams_[0] = stream;
  return {};
}

Result<void> TsMuxer::add_sound() {
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  if (info_.audio->config.empty()) {
    return make_error(Code::invalid_argument, "the sound has no configuration");
  }
  Result<av::Parameters> parameters = codec_parameters(*info_.audio);
  if (!parameters) return parameters.error();
  if (avcodec_parameters_copy(stream->codecpar, parameters->get()) < 0) return av::no_memory();
  stream->time_base = kStampBase;
  streams_[1] = stream;
  return {};
}

TsMuxer::~TsMuxer() {
  if (context_ == nullptr) return;
  av::LogCapture quiet;
  // Without the trailer the writer would keep its own memory.
  if (io_ && last_[0] != last_[1]) av_write_trailer(context_);
  avformat_free_context(context_);
}

Result<std::vector<std::uint8_t>> TsMuxer::write(const LiveUnit& unit) {
  const auto track = std::size_t(unit.track);
  if (streams_[track] == nullptr) {
    return make_error(Code::invalid_argument, "a unit of a track that was not passed to start()");
  }
  const bool face = unit.track == LiveTrack::face;
  const AVRational base{1, face ? int(info_.timescale) : info_.audio->sample_rate};
  const std::int64_t stamp =
      av_rescale_q(unit.time, base, kStampBase) + kTsTimeZero - kAddedByMuxer;
  if (stamp < 0 || stamp <= last_[track]) {
    return make_error(Code::invalid_argument, stamp < 0
                                                  ? "a unit is too early: times begin at -0.8 s"
                                                  : "the times of a track must ascend");
  }
  const std::vector<std::uint8_t> none;
  const auto& prefix = face && unit.intra ? info_.face_config : none;
  if (unit.bytes.empty() || unit.bytes.size() > 60000) {
    return make_error(Code::invalid_argument, "a unit is empty or longer than 60000 bytes");
  }
  av::LogCapture quiet;
  if (av_new_packet(packet_.get(), int(prefix.size() + unit.bytes.size())) < 0)
    return av::no_memory();
  if (!prefix.empty()) std::memcpy(packet_->data, prefix.data(), prefix.size());
  std::memcpy(packet_->data + prefix.size(), unit.bytes.data(), unit.bytes.size());
  packet_->stream_index = streams_[track]->index;
  packet_->pts = packet_->dts = stamp;
  packet_->duration = av_rescale_q(unit.duration, base, kStampBase);
  if (unit.intra || !face) packet_->flags |= AV_PKT_FLAG_KEY;
  int status = av_write_frame(context_, packet_.get());
  av_packet_unref(packet_.get());
  if (status >= 0) status = av_write_frame(context_, nullptr);  // it would collect small packets
  if (status < 0) return av::make_av_error(status, "the unit cannot be written");
  last_[track] = stamp;
  avio_flush(io_.get());
  std::vector<std::uint8_t> packets;
  packets.swap(bytes_);
  return program_map_.push(packets);
}

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
