#include "tools/formats/media/detail/sound/sound_start.h"

namespace animeme::media {
namespace {

// Audio packets to try until one decodes: sound that begins later begins where its header says.
constexpr int kPacketsToDecide = 64;

}  // namespace

SoundStart::SoundStart(const Input& input, AVStream* stream) : input_(input), stream_(stream) {
  if (stream_ == nullptr) return;
  Result<av::Codec> opened = open_audio_decoder(*stream_->codecpar, stream_->time_base);
  if (opened) codec_ = std::move(*opened);
  frame_.reset(av_frame_alloc());
  if (!codec_ || !frame_) give_up();
}

void SoundStart::try_packet(const AVPacket& packet) {
  const auto take = [&](AVFrame& frame) -> Result<void> {
    const bool played = !input_.is_mp4_family() || frame.pts >= 0 || covers_zero(frame);
    if (!time_ && frame.pts != AV_NOPTS_VALUE && frame.nb_samples > 0 && played) {
      time_ = first_played(input_, frame.pts);
    }
    return {};
  };
  (void)decode_packet(*codec_, &packet, *frame_, take);
  if (time_ || ++tried_ >= kPacketsToDecide) give_up();
}

bool SoundStart::covers_zero(const AVFrame& frame) const {
  return frame.pts != AV_NOPTS_VALUE && frame.sample_rate > 0 &&
         frame.pts + av_rescale_q(frame.nb_samples, {1, frame.sample_rate}, stream_->time_base) > 0;
}

void SoundStart::give_up() {
  codec_.reset();
  stream_->discard = AVDISCARD_ALL;  // the rest of the sound is not needed
}

}  // namespace animeme::media
