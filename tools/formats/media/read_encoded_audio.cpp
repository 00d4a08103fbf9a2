// Coded sound out of a file, as it is.
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>

#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/detail/sound/coded_packets.h"
#include "tools/formats/media/detail/tracks/face_track.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMostBytes = std::size_t(1) << 30;
constexpr int kAacFrame = 1024;
// Coarse clocks round packet times; only more than this is a gap.
constexpr int kGapPerSecond = 200;

struct FreeFilter {
  void operator()(AVBSFContext* filter) const { av_bsf_free(&filter); }
};

using GivePacket = std::function<Result<void>(AudioPacket)>;

// Puts the packets of one stream on the time line of read_audio().
class PacketCollector {
 public:
  PacketCollector(const Input& input, const AVStream& stream, const GivePacket& give)
      : input_(input), stream_(stream), give_(give) {}

  Result<void> open();
  Result<void> add(AVPacket* packet);  // nullptr: no more
  Result<EncodedAudio> finish();

 private:
  Result<void> take(const AVPacket& packet);
  std::int64_t place(const AVPacket& packet);
  std::int64_t samples_of(const AVPacket& packet) const;
  void set_length();

  const Input& input_;
  const AVStream& stream_;
  const GivePacket& give_;
  std::unique_ptr<AVBSFContext, FreeFilter> filter_;  // takes ADTS headers off
  av::Packet out_{av_packet_alloc()};
  EncodedAudio audio_;               // without packets
  std::optional<AudioPacket> last_;  // not handed over yet
  std::int64_t first_time_ = 0, first_duration_ = 0;
  bool constant_ = true;                // durations, but that of the last packet
  std::optional<std::int64_t> origin_;  // stream time of time 0, samples
  std::int64_t next_ = 0;
  std::size_t bytes_ = 0;
};

Result<void> PacketCollector::open() {
  const AVCodecParameters& parameters = *stream_.codecpar;
  AudioFormat& format = audio_.format;
  if (parameters.codec_id != AV_CODEC_ID_AAC && parameters.codec_id != AV_CODEC_ID_OPUS) {
    return make_error(Code::unsupported, std::string("the sound is ") +
                                             avcodec_get_name(parameters.codec_id) +
                                             "; only aac and opus can be taken as they are");
  }
  const bool opus = parameters.codec_id == AV_CODEC_ID_OPUS;
  format.codec = opus ? AudioCodec::opus : AudioCodec::aac;
  format.sample_rate = opus ? 48000 : parameters.sample_rate;
  format.channels = std::max(parameters.ch_layout.nb_channels, 1);
  format.frame_samples = opus ? 0 : parameters.frame_size > 0 ? parameters.frame_size : kAacFrame;
  if (format.sample_rate <= 0 || !out_) {
    return make_error(Code::syntax, "the audio track has no sample rate; the file is damaged");
  }
  if (parameters.extradata_size > 0) {
    format.config.assign(parameters.extradata, parameters.extradata + parameters.extradata_size);
    return {};
  }
  AVBSFContext* filter = nullptr;
  const AVBitStreamFilter* adts = opus ? nullptr : av_bsf_get_by_name("aac_adtstoasc");
  int status = adts == nullptr ? AVERROR_BSF_NOT_FOUND : av_bsf_alloc(adts, &filter);
  filter_.reset(filter);
  if (status >= 0) status = avcodec_parameters_copy(filter->par_in, &parameters);
  if (status >= 0) {
    filter->time_base_in = stream_.time_base;
    status = av_bsf_init(filter);
  }
  if (status >= 0) return {};
  return av::make_av_error(status, "the audio track has no decoder configuration");
}

Result<void> PacketCollector::add(AVPacket* packet) {
  if (!filter_) return packet != nullptr ? take(*packet) : Result<void>();
  if (av_bsf_send_packet(filter_.get(), packet) < 0) return {};  // damaged
  while (av_bsf_receive_packet(filter_.get(), out_.get()) >= 0) {
    std::size_t size = 0;
    const std::uint8_t* config =
        av_packet_get_side_data(out_.get(), AV_PKT_DATA_NEW_EXTRADATA, &size);
    if (config != nullptr) audio_.format.config.assign(config, config + size);
    Result<void> taken = take(*out_);
    av_packet_unref(out_.get());
    if (!taken) return taken;
  }
  return {};
}

std::int64_t PacketCollector::samples_of(const AVPacket& packet) const {
  const std::span<const std::uint8_t> bytes(packet.data, std::size_t(packet.size));
  std::int64_t samples =
      audio_.format.codec == AudioCodec::opus ? opus_samples(bytes) : audio_.format.frame_samples;
  std::size_t size = 0;
  const std::uint8_t* skip = av_packet_get_side_data(&packet, AV_PKT_DATA_SKIP_SAMPLES, &size);
  if (skip != nullptr && size >= 8) {
    samples = std::max<std::int64_t>(samples - std::int64_t(AV_RL32(skip + 4)), 1);
  } else if (input_.is_mp4_family() && packet.duration > 0) {
    const std::int64_t told =
        av_rescale_q(packet.duration, stream_.time_base, {1, audio_.format.sample_rate});
    samples = std::clamp<std::int64_t>(told, 1, samples);
  }
  return samples;
}

// Where the packet belongs, samples.
std::int64_t PacketCollector::place(const AVPacket& packet) {
  const std::int64_t stamp = packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
  if (stamp == AV_NOPTS_VALUE) return next_;
  const int rate = audio_.format.sample_rate;
  const std::int64_t time = av_rescale_q(stamp, stream_.time_base, {1, rate});
  if (!origin_) {
    // An edit list hides what lies before 0; elsewhere the decoder skips what the header says.
    const std::int64_t hidden = stream_.codecpar->initial_padding;
    origin_ = input_.is_mp4_family() ? std::max<std::int64_t>(time, 0) : time + hidden;
    return time - *origin_;
  }
  const std::int64_t placed = time - *origin_;
  return std::abs(placed - next_) <= rate / kGapPerSecond ? next_ : placed;
}

Result<void> PacketCollector::take(const AVPacket& packet) {
  if (packet.data == nullptr || packet.size <= 0) return {};
  const std::int64_t samples = samples_of(packet);
  const std::int64_t time = place(packet);
  const bool ascends = !last_ || time > last_->time;
  if (samples <= 0 || !ascends) return {};  // damaged
  bytes_ += std::size_t(packet.size);
  if (bytes_ > kMostBytes) {
    return make_error(Code::out_of_range, "the sound is larger than 1 GB; cut the file");
  }
  if (last_) {
    constant_ = constant_ && last_->duration == first_duration_;
    if (auto given = give_(std::move(*last_)); !given) return given;
  } else {
    first_time_ = time;
    first_duration_ = samples;
  }
  last_ = AudioPacket{{packet.data, packet.data + packet.size}, time, samples};
  next_ = time + samples;
  return {};
}

void PacketCollector::set_length() {
  audio_.length = next_;
  const std::int64_t rate = audio_.format.sample_rate;
  const std::optional<std::int64_t> told = end_of_sound(input_, stream_);
  if (!told || !origin_) return;
  const std::int64_t end = av_rescale_q(*told, stream_.time_base, {1, int(rate)}) - *origin_;
  if (end > 0 && end < next_ && next_ - end <= rate / kPaddingPerSecond) audio_.length = end;
}

Result<EncodedAudio> PacketCollector::finish() {
  if (!last_ || audio_.format.config.empty() || next_ <= 0) {
    return make_error(Code::syntax, "nothing in the audio track can be read");
  }
  set_length();
  // The last packet of a fragmented file is said to be whole.
  if (audio_.length > last_->time && audio_.length < last_->time + last_->duration) {
    last_->duration = audio_.length - last_->time;
  }
  AudioFormat& format = audio_.format;
  format.priming = int(std::clamp<std::int64_t>(-first_time_, 0, format.sample_rate));
  if (format.codec == AudioCodec::opus && constant_ && last_->duration <= first_duration_) {
    format.frame_samples = int(first_duration_);
  }
  if (auto given = give_(std::move(*last_)); !given) return given.error();
  return std::move(audio_);
}

Result<EncodedAudio> read_track(Input& input, const GivePacket& give) {
  FaceTracks().update(*input.context());
  Result<AVStream*> stream = choose_audio(input);
  if (!stream) return stream.error();
  PacketCollector sound(input, **stream, give);
  if (auto opened = sound.open(); !opened) return opened.error();
  Result<int> read =
      read_packets(input, (*stream)->index, [&](AVPacket& packet) { return sound.add(&packet); });
  if (!read) return read.error();
  if (auto ended = sound.add(nullptr); !ended) return ended.error();
  return sound.finish();
}

template <class Source>
Result<EncodedAudio> give_from(const Source& source, const GivePacket& give) {
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(source, nullptr);
  if (!input) return input.error();
  return read_track(**input, give);
}

// With its packets.
template <class Read>
Result<EncodedAudio> read_whole(const Read& read) {
  std::vector<AudioPacket> packets;
  Result<EncodedAudio> audio = read([&packets](AudioPacket packet) -> Result<void> {
    packets.push_back(std::move(packet));
    return {};
  });
  if (audio) audio->packets = std::move(packets);
  return audio;
}

}  // namespace

Result<EncodedAudio> read_coded_packets(const std::string& path, const GivePacket& give) {
  return av::guarded(path, [&] {
    return read_sound_of(path, [&](const auto& source) { return give_from(source, give); });
  });
}

Result<EncodedAudio> read_encoded_audio(const std::string& path) {
  return read_whole([&](const GivePacket& give) { return read_coded_packets(path, give); });
}

Result<EncodedAudio> read_encoded_audio(std::span<const std::uint8_t> file) {
  return read_whole(
      [&](const GivePacket& give) { return av::guarded([&] { return give_from(file, give); }); });
}

}  // namespace animeme::media
