#include "tools/formats/media/encoded_audio.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/sound/resampler.h"

namespace animeme::media {
namespace {

// The resampler gets blocks of this size, so that nothing depends on how the sound was cut. Samples
// of each channel.
constexpr std::size_t kEncoderBlock = 256;

constexpr int kMostEffort = 10;
constexpr int kMostLoss = 50;  // percent
constexpr int kAnalysing = 7;  // libopus looks at the sound from this complexity on
// An encoder that follows another hears so many frames before its packets are used, so that what it
// predicts from is nearly what decoders have: 0.2 s of Opus.
constexpr int kWarmUp = 10;

// The encoders refuse NaN and infinity for the whole track, and a resampler would spread them.
float legal_sample(float sample) {
  if (sample >= -1.0f && sample <= 1.0f) return sample;
  return sample > 1.0f ? 1.0f : sample < -1.0f ? -1.0f : 0.0f;
}

Result<void> check_loss(int percent) {
  if (percent >= 0 && percent <= kMostLoss) return {};
  return make_error(Code::invalid_argument, "the expected loss of packets is 0 to 50 percent");
}

Result<void> check(int sample_rate, const AudioSettings& settings, int channels) {
  if (channels != 1 && channels != 2) {
    return make_error(Code::invalid_argument, "sound is encoded in one or two channels");
  }
  if (sample_rate < kLowestRate || sample_rate > kHighestRate) {
    return make_error(Code::invalid_argument, "the sample rate must be 1000 to 384000 Hz");
  }
  const BitRates rates = bit_rates(settings.codec);
  const int wanted = settings.bit_rate;
  if (wanted != 0 && (wanted < rates.lowest || wanted > rates.highest)) {
    return make_error(Code::invalid_argument, std::string("the bit rate of ") +
                                                  name_of(settings.codec) + " must be " +
                                                  std::to_string(rates.lowest) + " to " +
                                                  std::to_string(rates.highest) + " bits a second");
  }
  if (settings.effort < 0 || settings.effort > kMostEffort) {
    return make_error(Code::invalid_argument, "the effort of an encoder of sound is 0 to 10");
  }
  if (settings.expected_loss == AudioSettings::kLossByReports) return {};
  return check_loss(settings.expected_loss);
}

const AVCodec* find_encoder(AudioCodec codec) {
  // libavcodec's own Opus encoder is called experimental by its authors.
  return codec == AudioCodec::opus ? avcodec_find_encoder_by_name("libopus")
                                   : avcodec_find_encoder(AV_CODEC_ID_AAC);
}

Result<av::Codec> open_encoder(const AudioSettings& settings, int sample_rate,
                               std::int64_t bit_rate, int channels) {
  const AudioCodec codec = settings.codec;
  const AVCodec* encoder = find_encoder(codec);
  if (encoder == nullptr) {
    return make_error(Code::unsupported,
                      std::string("this FFmpeg was built without an encoder for ") +
                          name_of(codec) + "; choose the other codec");
  }
  av::Codec context(avcodec_alloc_context3(encoder));
  if (!context) return av::no_memory();
  context->sample_fmt = codec == AudioCodec::opus ? AV_SAMPLE_FMT_FLT : AV_SAMPLE_FMT_FLTP;
  context->sample_rate = sample_rate;
  context->time_base = {1, sample_rate};
  av_channel_layout_default(&context->ch_layout, channels);
  context->bit_rate = bit_rate;
  context->thread_count = 1;
  if (codec == AudioCodec::opus) {
    context->compression_level = settings.effort;
    // Without measuring first, its bit rate is far from the target.
    if (settings.effort < kAnalysing) av_opt_set(context->priv_data, "vbr", "constrained", 0);
    if (settings.expected_loss > 0) {
      // What is repeated belongs to the part of Opus for speech, which music and tones do not use.
      av_opt_set(context->priv_data, "application", "voip", 0);
      av_opt_set(context->priv_data, "fec", "1", 0);
      const std::string loss = std::to_string(settings.expected_loss);
      av_opt_set(context->priv_data, "packet_loss", loss.c_str(), 0);
    }
  }
  if (codec == AudioCodec::aac) {
    const bool fast = settings.aac_search == AacSearch::fast;
    av_opt_set(context->priv_data, "aac_coder", fast ? "fast" : "twoloop", 0);
  }
  context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  const int status = avcodec_open2(context.get(), encoder, nullptr);
  if (status < 0) {
    return av::make_av_error(
        status, std::string("the encoder of ") + name_of(codec) + " cannot be started");
  }
  return context;
}

}  // namespace

const char* name_of(AudioCodec codec) { return codec == AudioCodec::opus ? "opus" : "aac"; }

struct AudioEncoder::Impl {
  AudioFormat format;
  av::Codec codec;
  av::Frame frame{av_frame_alloc()};
  av::Packet packet{av_packet_alloc()};
  std::optional<Resampler> resampler;
  std::vector<float> block;    // for the resampler: less than kEncoderBlock samples a channel
  std::vector<float> pending;  // for the encoder: less than a frame after each push()
  std::int64_t sent = 0;       // samples of each channel
  bool finished = false;

  AudioSettings settings;
  bool follows_loss = false;      // AudioSettings::kLossByReports
  int loss = 0, wanted_loss = 0;  // percent: of the encoder that was opened last, and to come
  av::Codec successor;            // takes over when it has heard kWarmUp frames; usually null
  int successor_heard = 0;        // frames

  ~Impl() {
    const av::LogCapture log;  // encoders say goodbye
    codec.reset();
    successor.reset();
  }
  Result<void> open(int sample_rate, const AudioSettings& settings, int channels);
  std::size_t channels() const { return std::size_t(format.channels); }
  Result<void> take(std::span<const float> samples);
  Result<void> resample_block();
  Result<void> encode(bool all, std::vector<AudioPacket>& out);
  void follow_loss();
  void warm_up();
  int send(std::span<const float> samples);
  Result<void> receive(std::vector<AudioPacket>& out);
};

Result<void> AudioEncoder::Impl::open(int sample_rate, const AudioSettings& wanted, int channels) {
  if (!frame || !packet) return av::no_memory();
  settings = wanted;
  settings.bit_rate = int(coded_bit_rate(wanted, sample_rate, channels));
  follows_loss = wanted.codec == AudioCodec::opus && wanted.expected_loss < 0;
  const int rate = coded_sample_rate(settings.codec, sample_rate);
  Result<av::Codec> opened = open_encoder(settings, rate, settings.bit_rate, channels);
  if (!opened) return opened.error();
  codec = std::move(*opened);
  format = {settings.codec, rate, channels, codec->frame_size, codec->initial_padding, {}};
  format.config.assign(codec->extradata, codec->extradata + codec->extradata_size);
  if (rate == sample_rate) return {};
  const std::uint64_t layout = channels == 2 ? AV_CH_LAYOUT_STEREO : AV_CH_LAYOUT_MONO;
  Result<Resampler> made =
      Resampler::open({sample_rate, AV_SAMPLE_FMT_FLT, channels, layout}, rate, pending, channels);
  if (!made) return made.error();
  resampler.emplace(std::move(*made));
  return {};
}

Result<void> AudioEncoder::Impl::resample_block() {
  const auto* plane = reinterpret_cast<const std::uint8_t*>(block.data());
  Result<void> added = resampler->add(&plane, int(block.size() / channels()));
  block.clear();
  return added;
}

Result<void> AudioEncoder::Impl::take(std::span<const float> samples) {
  if (!resampler) {
    for (const float sample : samples) pending.push_back(legal_sample(sample));
    return {};
  }
  for (const float sample : samples) {
    block.push_back(legal_sample(sample));
    if (block.size() < kEncoderBlock * channels()) continue;
    Result<void> done = resample_block();
    if (!done) return done;
  }
  return {};
}

int AudioEncoder::Impl::send(std::span<const float> samples) {
  frame->format = codec->sample_fmt;
  frame->sample_rate = codec->sample_rate;
  const std::size_t count = samples.size() / channels();
  frame->nb_samples = int(count);
  frame->pts = sent;
  int status = av_channel_layout_copy(&frame->ch_layout, &codec->ch_layout);
  if (status >= 0) status = av_frame_get_buffer(frame.get(), 0);
  if (status < 0) return status;
  // Resampling may overshoot.
  const bool planar = av_sample_fmt_is_planar(codec->sample_fmt) != 0;
  for (std::size_t i = 0; i < count * channels(); ++i) {
    const std::size_t plane = planar ? i % channels() : 0;
    auto* target = reinterpret_cast<float*>(frame->data[plane]);
    target[planar ? i / channels() : i] = legal_sample(samples[i]);
  }
  sent += std::int64_t(count);
  status = avcodec_send_frame(codec.get(), frame.get());
  if (successor) warm_up();
  av_frame_unref(frame.get());
  return status;
}

// libopus could change what it expects, but FFmpeg passes that on only when an encoder is opened:
// another one hears the same frames and takes over.
void AudioEncoder::Impl::follow_loss() {
  if (successor && successor_heard >= kWarmUp) codec = std::move(successor);
  if (successor || loss == wanted_loss) return;
  settings.expected_loss = loss = wanted_loss;
  Result<av::Codec> opened =
      open_encoder(settings, format.sample_rate, settings.bit_rate, format.channels);
  if (!opened || (*opened)->initial_padding != format.priming) return;  // the old one does it
  successor = std::move(*opened);
  successor_heard = 0;
}

// Gives the successor the frame that has been sent. Its packets are nobody's yet.
void AudioEncoder::Impl::warm_up() {
  if (avcodec_send_frame(successor.get(), frame.get()) < 0) return successor.reset();
  while (avcodec_receive_packet(successor.get(), packet.get()) >= 0) av_packet_unref(packet.get());
  ++successor_heard;
}

Result<void> AudioEncoder::Impl::receive(std::vector<AudioPacket>& out) {
  for (;;) {
    const int status = avcodec_receive_packet(codec.get(), packet.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return {};
    if (status < 0) {
      return make_error(Code::io, "the sound cannot be encoded: " + av::error_text(status));
    }
    // Padding behind the last sample of a sound of one or two frames.
    if (packet->size > 0 && packet->duration > 0) {
      out.push_back({{packet->data, packet->data + packet->size}, packet->pts, packet->duration});
    }
    av_packet_unref(packet.get());
  }
}

Result<void> AudioEncoder::Impl::encode(bool all, std::vector<AudioPacket>& out) {
  const auto size = std::size_t(codec->frame_size) * channels();
  const std::span<const float> samples(pending);
  std::size_t at = 0;
  while (samples.size() - at >= size || (all && samples.size() - at >= channels())) {
    const std::size_t count = std::min(size, samples.size() - at);
    follow_loss();
    const int status = send(samples.subspan(at, count));
    if (status < 0) {
      return make_error(Code::io, "the sound cannot be encoded: " + av::error_text(status));
    }
    at += count;
    Result<void> received = receive(out);
    if (!received) return received;
  }
  pending.erase(pending.begin(), pending.begin() + std::ptrdiff_t(at));
  return {};
}

AudioEncoder::AudioEncoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AudioEncoder::AudioEncoder(AudioEncoder&&) noexcept = default;
AudioEncoder& AudioEncoder::operator=(AudioEncoder&&) noexcept = default;
AudioEncoder::~AudioEncoder() = default;

Result<AudioEncoder> AudioEncoder::open(int sample_rate, const AudioSettings& settings,
                                        int channels) {
  return av::guarded([&]() -> Result<AudioEncoder> {
    if (auto legal = check(sample_rate, settings, channels); !legal) return legal.error();
    const av::LogCapture log;
    auto impl = std::make_unique<Impl>();
    if (auto opened = impl->open(sample_rate, settings, channels); !opened) return opened.error();
    return AudioEncoder(std::move(impl));
  });
}

const AudioFormat& AudioEncoder::format() const { return impl_->format; }

Result<void> AudioEncoder::expect_loss(int percent) {
  if (auto legal = check_loss(percent); !legal) return legal;
  if (impl_->follows_loss) impl_->wanted_loss = percent;
  return {};
}

Result<std::vector<AudioPacket>> AudioEncoder::push(std::span<const float> samples) {
  return av::guarded([&]() -> Result<std::vector<AudioPacket>> {
    if (impl_->finished) {
      return make_error(Code::invalid_argument, "the sound was finished; open another encoder");
    }
    const av::LogCapture log;
    std::vector<AudioPacket> packets;
    if (auto taken = impl_->take(samples); !taken) return taken.error();
    if (auto done = impl_->encode(false, packets); !done) return done.error();
    return packets;
  });
}

Result<std::vector<AudioPacket>> AudioEncoder::finish() {
  return av::guarded([&]() -> Result<std::vector<AudioPacket>> {
    std::vector<AudioPacket> packets;
    if (std::exchange(impl_->finished, true)) return packets;
    const av::LogCapture log;
    if (impl_->resampler) {
      Result<void> rest = impl_->resample_block();
      if (rest) rest = impl_->resampler->finish();
      if (!rest) return rest.error();
    }
    if (auto done = impl_->encode(true, packets); !done) return done.error();
    if (impl_->sent == 0) return packets;  // an encoder that had no sound has no delay to flush
    (void)avcodec_send_frame(impl_->codec.get(), nullptr);
    if (auto done = impl_->receive(packets); !done) return done.error();
    return packets;
  });
}

Result<EncodedAudio> encode_audio(const Pcm& pcm, const AudioSettings& settings) {
  if (pcm.samples.empty()) return make_error(Code::invalid_argument, "the sound is empty");
  Result<AudioEncoder> encoder = AudioEncoder::open(pcm.sample_rate, settings);
  if (!encoder) return encoder.error();
  Result<std::vector<AudioPacket>> packets = encoder->push(pcm.samples);
  if (!packets) return packets.error();
  Result<std::vector<AudioPacket>> rest = encoder->finish();
  if (!rest) return rest.error();
  return av::guarded([&]() -> Result<EncodedAudio> {
    EncodedAudio audio{encoder->format(), std::move(*packets), 0};
    for (AudioPacket& packet : *rest) audio.packets.push_back(std::move(packet));
    if (audio.packets.empty()) {
      return make_error(Code::invalid_argument, "the sound is shorter than one coded sample");
    }
    audio.length = audio.packets.back().time + audio.packets.back().duration;
    return audio;
  });
}

}  // namespace animeme::media
