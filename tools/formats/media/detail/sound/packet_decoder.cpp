#include "tools/formats/media/detail/sound/packet_decoder.h"

#include <string>
#include <utility>

#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/audio_parameters.h"

namespace animeme::media {

Result<void> PacketDecoder::open(const AudioFormat& format) {
  if (!packet_ || !frame_) return av::no_memory();
  format_ = format;
  Result<av::Parameters> parameters = codec_parameters(format_);
  if (!parameters) return parameters.error();
  // Priming is skipped by time, where it is skipped.
  Result<av::Codec> codec =
      open_audio_decoder(**parameters, {1, format_.sample_rate}, AV_CODEC_FLAG2_SKIP_MANUAL);
  if (!codec) return codec.error();
  codec_ = std::move(*codec);
  return {};
}

Result<void> PacketDecoder::mix(AVFrame& frame, const Take& take) {
  if (frame.nb_samples <= 0) return {};
  if (frame.sample_rate != format_.sample_rate) {
    return make_error(Code::unsupported, "the sound has " + std::to_string(frame.sample_rate) +
                                             " Hz where its description says " +
                                             std::to_string(format_.sample_rate) + " Hz");
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
  Result<void> taken = take(at_, mono_);
  at_ += std::int64_t(mono_.size());
  return taken;
}

Result<void> PacketDecoder::decode(const AudioPacket* packet, const Take& take) {
  if (packet != nullptr) {
    if (packet->time != next_) {
      if (next_) avcodec_flush_buffers(codec_.get());
      at_ = packet->time;
    }
    Result<void> copied = copy_packet(*packet, format_, *packet_);
    if (!copied) return copied;
    next_ = packet->time + packet->duration;
  }
  Result<bool> good = decode_packet(*codec_, packet != nullptr ? packet_.get() : nullptr, *frame_,
                                    [&](AVFrame& frame) { return mix(frame, take); });
  av_packet_unref(packet_.get());
  if (!good) return good.error();
  if (!*good) next_ = INT64_MAX;  // whatever comes, it does not continue this
  return {};
}

}  // namespace animeme::media
