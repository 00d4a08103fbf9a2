#include "tools/media/detail/aac_encoder.h"

#include <algorithm>
#include <array>

namespace animeme::media {
namespace {

constexpr std::array<int, 13> kAacRates = {7350,  8000,  11025, 12000, 16000, 22050, 24000,
                                           32000, 44100, 48000, 64000, 88200, 96000};
constexpr std::int64_t kMostBitsPerSample = 6;  // 6144 bits a frame of 1024 samples

}  // namespace

int aac_sample_rate(int sample_rate) {
  const auto* rate = std::lower_bound(kAacRates.begin(), kAacRates.end(), sample_rate);
  return rate == kAacRates.end() ? kAacRates.back() : *rate;
}

Result<AacEncoder> AacEncoder::open(const Pcm& pcm, int bit_rate) {
  const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_AAC);
  if (encoder == nullptr) {
    return make_error(Code::unsupported, "this FFmpeg was built without an AAC encoder");
  }
  AacEncoder aac;
  aac.pcm_ = &pcm;
  aac.codec_.reset(avcodec_alloc_context3(encoder));
  aac.frame_.reset(av_frame_alloc());
  if (!aac.codec_ || !aac.frame_) return make_error(Code::out_of_range, "not enough memory");
  AVCodecContext& codec = *aac.codec_;
  codec.sample_fmt = AV_SAMPLE_FMT_FLTP;
  codec.sample_rate = pcm.sample_rate;
  codec.time_base = {1, pcm.sample_rate};
  av_channel_layout_default(&codec.ch_layout, 1);
  codec.bit_rate =
      std::min<std::int64_t>(bit_rate, kMostBitsPerSample * std::int64_t(pcm.sample_rate));
  codec.thread_count = 1;
  codec.flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  const int status = avcodec_open2(&codec, encoder, nullptr);
  if (status < 0) return av::make_av_error(status, "the AAC encoder cannot be started");
  return aac;
}

int AacEncoder::send_frame() {
  if (flushed_) return AVERROR_EOF;
  const std::size_t left = pcm_->samples.size() - at_;
  if (left == 0) {
    flushed_ = true;
    return avcodec_send_frame(codec_.get(), nullptr);
  }
  const std::size_t count = std::min(left, std::size_t(codec_->frame_size));
  frame_->format = AV_SAMPLE_FMT_FLTP;
  frame_->sample_rate = codec_->sample_rate;
  frame_->nb_samples = int(count);
  frame_->pts = std::int64_t(at_);
  int status = av_channel_layout_copy(&frame_->ch_layout, &codec_->ch_layout);
  if (status >= 0) status = av_frame_get_buffer(frame_.get(), 0);
  if (status < 0) return status;
  auto* target = reinterpret_cast<float*>(frame_->data[0]);
  for (std::size_t i = 0; i < count; ++i) {
    const float sample = pcm_->samples[at_ + i];
    // The encoder refuses NaN and infinity for the whole file.
    target[i] = sample >= -1.0f && sample <= 1.0f ? sample
                : sample > 1.0f                   ? 1.0f
                : sample < -1.0f                  ? -1.0f
                                                  : 0.0f;
  }
  at_ += count;
  status = avcodec_send_frame(codec_.get(), frame_.get());
  av_frame_unref(frame_.get());
  return status;
}

Result<bool> AacEncoder::next(AVPacket& packet) {
  for (;;) {
    int status = avcodec_receive_packet(codec_.get(), &packet);
    if (status >= 0) return true;
    if (status == AVERROR_EOF) return false;
    if (status == AVERROR(EAGAIN)) status = send_frame();
    if (status < 0) return av::make_av_error(status, "the sound cannot be encoded");
  }
}

}  // namespace animeme::media
