// Coded sound back to samples.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "tools/media/audio.h"
#include "tools/media/detail/audio_decoder.h"
#include "tools/media/detail/audio_parameters.h"
#include "tools/media/detail/resampler.h"
#include "tools/media/encoded_audio.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kLongestSound = 3 * 3600;  // seconds

// Puts decoded frames at their places on the time line of the packets.
class Decoding {
 public:
  explicit Decoding(const EncodedAudio& audio)
      : audio_(audio), end_(audio.packets.back().time + audio.packets.back().duration) {
    if (audio.length > 0) end_ = audio.length;
    pcm_.sample_rate = audio.format.sample_rate;
  }

  Result<Pcm> run();

 private:
  Result<void> open();
  Result<void> decode(const AudioPacket* packet);
  Result<void> place(AVFrame& frame);

  const EncodedAudio& audio_;
  std::int64_t end_;
  av::Codec codec_;
  av::Packet packet_{av_packet_alloc()};
  av::Frame frame_{av_frame_alloc()};
  std::optional<Resampler> mixer_;  // to one channel; the rate stays
  std::vector<float> mono_;
  Pcm pcm_;
  std::int64_t at_ = 0;    // where the next decoded sample belongs
  std::int64_t next_ = 0;  // where the next packet belongs if none is missing
  bool any_ = false;
};

Result<void> Decoding::open() {
  if (!packet_ || !frame_) return av::no_memory();
  Result<av::Parameters> parameters = codec_parameters(audio_.format);
  if (!parameters) return parameters.error();
  // Priming is skipped here, by time.
  Result<av::Codec> codec =
      open_audio_decoder(**parameters, {1, audio_.format.sample_rate}, AV_CODEC_FLAG2_SKIP_MANUAL);
  if (!codec) return codec.error();
  codec_ = std::move(*codec);
  return {};
}

Result<void> Decoding::place(AVFrame& frame) {
  if (frame.nb_samples <= 0) return {};
  if (frame.sample_rate != audio_.format.sample_rate) {
    return make_error(Code::unsupported, "the sound has " + std::to_string(frame.sample_rate) +
                                             " Hz where its description says " +
                                             std::to_string(audio_.format.sample_rate) + " Hz");
  }
  const SoundFormat format{frame.sample_rate, AVSampleFormat(frame.format),
                           frame.ch_layout.nb_channels, 0};
  if (!mixer_ || mixer_->from() != format) {
    Result<Resampler> made = Resampler::open(format, frame.sample_rate, mono_);
    if (!made) return made.error();
    mixer_.emplace(std::move(*made));
  }
  mono_.clear();
  Result<void> mixed = mixer_->add(frame.extended_data, frame.nb_samples);
  if (!mixed) return mixed;
  any_ = true;
  for (const float sample : mono_) {
    if (at_ >= 0 && at_ < end_) pcm_.samples[std::size_t(at_)] = sample;
    ++at_;
  }
  return {};
}

// A packet that cannot be decoded is as good as missing.
Result<void> Decoding::decode(const AudioPacket* packet) {
  if (packet != nullptr) {
    if (packet->time != next_) {
      avcodec_flush_buffers(codec_.get());
      at_ = packet->time;
    }
    Result<void> copied = copy_packet(*packet, audio_.format, *packet_);
    if (!copied) return copied;
    next_ = packet->time + packet->duration;
  }
  Result<bool> good = decode_packet(*codec_, packet != nullptr ? packet_.get() : nullptr, *frame_,
                                    [&](AVFrame& frame) { return place(frame); });
  av_packet_unref(packet_.get());
  if (!good) return good.error();
  if (!*good) next_ = end_ + 1;  // whatever comes, it does not continue this
  return {};
}

Result<Pcm> Decoding::run() {
  const av::LogCapture log;
  if (end_ / audio_.format.sample_rate >= kLongestSound) {
    return make_error(Code::out_of_range, "the sound is longer than 3 hours; cut it");
  }
  if (auto opened = open(); !opened) return opened.error();
  pcm_.samples.resize(std::size_t(std::max<std::int64_t>(end_, 0)));
  at_ = next_ = audio_.packets.front().time;
  for (const AudioPacket& packet : audio_.packets) {
    if (auto done = decode(&packet); !done) return done.error();
  }
  if (auto done = decode(nullptr); !done) return done.error();
  if (!any_) return make_error(Code::syntax, "nothing in the sound can be decoded");
  return std::move(pcm_);
}

}  // namespace

Result<Pcm> decode_audio(const EncodedAudio& audio) {
  return av::guarded([&]() -> Result<Pcm> {
    if (auto legal = check_audio(audio); !legal) return legal.error();
    return Decoding(audio).run();
  });
}

}  // namespace animeme::media
