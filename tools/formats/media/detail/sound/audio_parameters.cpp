#include "tools/formats/media/detail/sound/audio_parameters.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "tools/formats/media/detail/ffmpeg/invalid.h"
#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"

namespace animeme::media {
namespace {

constexpr int kOpusRate = 48000;
constexpr std::int64_t kMostAacBitsPerSample = 6;  // 6144 bits a frame of 1024 samples

}  // namespace

int coded_sample_rate(AudioCodec codec, int sample_rate) {
  if (codec == AudioCodec::opus) return kOpusRate;
  const auto rate = std::find_if(kAacRates.rbegin(), kAacRates.rend(),
                                 [&](int candidate) { return candidate >= sample_rate; });
  return rate == kAacRates.rend() ? kAacRates.front() : *rate;
}

BitRates bit_rates(AudioCodec codec) {
  return codec == AudioCodec::opus ? BitRates{6000, 256000, 40000} : BitRates{8000, 320000, 64000};
}

std::int64_t coded_bit_rate(const AudioSettings& settings, int sample_rate, int channels) {
  std::int64_t bits =
      settings.bit_rate != 0 ? settings.bit_rate : bit_rates(settings.codec).usual * channels;
  if (settings.codec == AudioCodec::aac) {
    const int rate = coded_sample_rate(settings.codec, sample_rate);
    bits = std::min(bits, kMostAacBitsPerSample * rate * channels);
  }
  return bits;
}

Result<av::Parameters> codec_parameters(const AudioFormat& format, std::int64_t bit_rate) {
  if (format.sample_rate <= 0 || format.channels <= 0 || format.channels > 64) {
    return invalid("the sound needs a sample rate and 1 to 64 channels");
  }
  av::Parameters parameters(avcodec_parameters_alloc());
  if (!parameters || !av::set_extradata(*parameters, format.config)) {
    return av::no_memory();
  }
  parameters->codec_type = AVMEDIA_TYPE_AUDIO;
  parameters->codec_id = format.codec == AudioCodec::opus ? AV_CODEC_ID_OPUS : AV_CODEC_ID_AAC;
  if (format.codec == AudioCodec::aac) parameters->profile = FF_PROFILE_AAC_LOW;
  parameters->format = AV_SAMPLE_FMT_FLTP;
  parameters->sample_rate = format.sample_rate;
  parameters->bit_rate = bit_rate;
  parameters->frame_size = format.frame_samples;
  parameters->initial_padding = format.priming;
  av_channel_layout_default(&parameters->ch_layout, format.channels);
  return parameters;
}

std::int64_t mean_bit_rate(const EncodedAudio& audio) {
  double bytes = 0;
  double samples = 0;
  for (const AudioPacket& packet : audio.packets) {
    bytes += double(packet.bytes.size());
    samples += double(packet.duration);
  }
  return samples > 0 ? std::int64_t(bytes * 8 * audio.format.sample_rate / samples) : 0;
}

Result<void> check_audio(const EncodedAudio& audio) {
  if (audio.packets.empty()) return invalid("the sound is empty");
  if (audio.format.config.empty()) return invalid("the sound lacks its decoder configuration");
  std::int64_t last = -kLongestTime;
  for (std::size_t i = 0; i < audio.packets.size(); ++i) {
    const AudioPacket& packet = audio.packets[i];
    const std::string name = "sound packet " + std::to_string(i);
    if (packet.bytes.empty()) return invalid(name + " is empty");
    if (packet.bytes.size() > kLargestUnit) return invalid(name + " is larger than 16 MB");
    if (packet.duration <= 0 || packet.duration > kLongestTime) {
      return invalid(name + " needs a positive duration");
    }
    if (packet.time <= last || packet.time > kLongestTime) {
      return invalid(name + " has the time " + std::to_string(packet.time) + "; times must ascend");
    }
    last = packet.time;
  }
  return {};
}

Result<void> copy_packet(const AudioPacket& source, const AudioFormat& format, AVPacket& target) {
  if (av_new_packet(&target, int(source.bytes.size())) < 0) return av::no_memory();
  std::memcpy(target.data, source.bytes.data(), source.bytes.size());
  target.pts = target.dts = source.time;
  target.duration = source.duration;
  target.flags |= AV_PKT_FLAG_KEY;
  const std::int64_t surplus = format.frame_samples - source.duration;
  if (format.codec != AudioCodec::opus || format.frame_samples == 0 || surplus <= 0) return {};
  constexpr std::size_t kSize = 10;  // skip at begin, at end, two reasons
  std::uint8_t* skip = av_packet_new_side_data(&target, AV_PKT_DATA_SKIP_SAMPLES, kSize);
  if (skip == nullptr) return av::no_memory();
  std::memset(skip, 0, kSize);
  AV_WL32(skip + 4, std::uint32_t(surplus));
  return {};
}

}  // namespace animeme::media
