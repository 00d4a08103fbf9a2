#include "tools/media/read_sound.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "tools/media/detail/face_track.h"
#include "tools/media/detail/sound_start.h"

namespace animeme::media {
namespace {

constexpr int kAacFrame = 1024;
constexpr int kOpusGrid = 120;                   // samples: Opus packets last multiples of 2.5 ms
constexpr std::size_t kMostPackets = 4'000'000;  // 22 hours at 20 ms
constexpr std::size_t kMostBytes = std::size_t(1) << 30;
// Stamps are off by half a millisecond in mkv; less than this is rounding, not a gap.
constexpr int kRoundingPerSecond = 500;

Result<AudioFormat> format_of(const AVStream& stream) {
  const AVCodecParameters& parameters = *stream.codecpar;
  AudioFormat format;
  if (parameters.codec_id == AV_CODEC_ID_AAC && parameters.extradata_size > 0) {
    format.codec = AudioCodec::aac;
    format.frame_samples = parameters.frame_size > 0 ? parameters.frame_size : kAacFrame;
    format.sample_rate = parameters.sample_rate;
  } else if (parameters.codec_id == AV_CODEC_ID_OPUS && parameters.extradata_size > 0) {
    format.codec = AudioCodec::opus;
    format.frame_samples = 0;
    format.sample_rate = 48000;
  } else {
    return make_error(Code::unsupported,
                      std::string("the sound is ") + avcodec_get_name(parameters.codec_id) +
                          ", not AAC or Opus in packets of their own; it has to be coded again");
  }
  format.channels = parameters.ch_layout.nb_channels;
  if (format.sample_rate <= 0 || format.channels <= 0) {
    return make_error(Code::syntax, "the audio track does not tell its rate or channels");
  }
  format.config.assign(parameters.extradata, parameters.extradata + parameters.extradata_size);
  return format;
}

class SoundReader {
 public:
  SoundReader(Input& input, AVStream& stream)
      : input_(input), stream_(stream), start_(input, &stream) {}

  Result<EncodedAudio> read();

 private:
  Result<void> read_packets();
  Result<void> take(const AVPacket& packet);
  void set_times();

  Input& input_;
  AVStream& stream_;
  SoundStart start_;
  EncodedAudio audio_;
  std::size_t bytes_ = 0;
};

// Times are samples, not yet from sample 0.
Result<void> SoundReader::take(const AVPacket& packet) {
  if (packet.size <= 0) return {};
  if (start_.searching()) start_.try_packet(packet);
  bytes_ += std::size_t(packet.size);
  if (audio_.packets.size() >= kMostPackets || bytes_ > kMostBytes) {
    return make_error(Code::out_of_range, "the sound is longer than 22 hours or 1 GB");
  }
  const AVRational samples = {1, audio_.format.sample_rate};
  AudioPacket out;
  out.bytes.assign(packet.data, packet.data + packet.size);
  std::int64_t lasts = audio_.format.frame_samples;
  if (audio_.format.codec == AudioCodec::opus) {
    const std::int64_t stated = av_rescale_q(packet.duration, stream_.time_base, samples);
    lasts = std::max<std::int64_t>(1, (stated + kOpusGrid / 2) / kOpusGrid) * kOpusGrid;
  }
  out.duration = lasts;
  const bool first = audio_.packets.empty();
  const std::int64_t expected =
      first ? 0 : audio_.packets.back().time + audio_.packets.back().duration;
  out.time = packet.pts == AV_NOPTS_VALUE ? expected
                                          : av_rescale_q(packet.pts, stream_.time_base, samples);
  const std::int64_t off = std::abs(out.time - expected);
  if (!first && (off <= audio_.format.sample_rate / kRoundingPerSecond || out.time < expected)) {
    out.time = expected;
  }
  audio_.packets.push_back(std::move(out));
  return {};
}

Result<void> SoundReader::read_packets() {
  const av::Packet packet(av_packet_alloc());
  if (!packet) return make_error(Code::out_of_range, "not enough memory");
  while (av_read_frame(input_.context(), packet.get()) >= 0) {
    Result<void> taken;
    if (packet->stream_index == stream_.index) taken = take(*packet);
    av_packet_unref(packet.get());
    if (!taken) return taken;
  }
  if (input_.exhausted()) return make_error(Code::syntax, "the file's index is damaged");
  return {};
}

void SoundReader::set_times() {
  const AVRational samples = {1, audio_.format.sample_rate};
  std::int64_t zero = audio_.packets.front().time;
  if (start_.time()) zero = av_rescale_q(*start_.time(), stream_.time_base, samples);
  for (AudioPacket& packet : audio_.packets) packet.time -= zero;
  audio_.format.priming = int(std::clamp<std::int64_t>(-audio_.packets.front().time, 0, 1 << 20));
  AudioPacket& last = audio_.packets.back();
  const std::int64_t end = last.time + last.duration;
  const bool stated = input_.is_mp4_family() && stream_.duration > 0 &&
                      stream_.start_time != AV_NOPTS_VALUE && stream_.duration < INT64_MAX / 4 &&
                      std::abs(stream_.start_time) < INT64_MAX / 4;
  if (!stated) return;
  const std::int64_t length =
      av_rescale_q(stream_.start_time + stream_.duration, stream_.time_base, samples) - zero;
  if (length <= 0 || length > end || end - length >= 4 * last.duration) return;
  audio_.length = length;
  last.duration = std::max<std::int64_t>(1, std::min(last.duration, length - last.time));
}

Result<EncodedAudio> SoundReader::read() {
  Result<AudioFormat> format = format_of(stream_);
  if (!format) return format.error();
  audio_.format = std::move(*format);
  if (auto done = read_packets(); !done) return done.error();
  if (audio_.packets.empty()) {
    return make_error(Code::syntax, "the audio track of " + input_.format() + " is empty");
  }
  set_times();
  return std::move(audio_);
}

Result<EncodedAudio> read_from(const std::string& path) {
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(path, nullptr);
  if (!input) return input.error();
  AVFormatContext& file = *(*input)->context();
  FaceTracks faces;
  faces.update(file);
  const int status = avformat_find_stream_info(&file, nullptr);
  if (status < 0) return av::make_av_error(status, "the file is damaged");
  const std::optional<int> index = find_audio(**input);
  if (!index) return make_error(Code::not_found, "the file has no audio track");
  for (unsigned i = 0; i < file.nb_streams; ++i) {
    if (int(i) != *index) file.streams[i]->discard = AVDISCARD_ALL;
  }
  return SoundReader(**input, *file.streams[*index]).read();
}

}  // namespace

Result<EncodedAudio> read_encoded_audio(const std::string& path) {
  return av::guarded([&]() -> Result<EncodedAudio> {
    Result<EncodedAudio> audio = read_from(path);
    if (!audio) return std::move(audio.error()).in_file(path);
    return audio;
  });
}

}  // namespace animeme::media
