#include "tools/media/detail/sound_source.h"

#include <algorithm>
#include <span>
#include <utility>

#include "tools/media/detail/audio_parameters.h"

namespace animeme::media {

Result<SoundSource> SoundSource::coding(const Pcm& pcm, const AudioSettings& settings) {
  Result<AudioEncoder> encoder = AudioEncoder::open(pcm.sample_rate, settings);
  if (!encoder) return encoder.error();
  SoundSource source;
  source.pcm_ = &pcm;
  source.encoder_.emplace(std::move(*encoder));
  source.bit_rate_ = coded_bit_rate(settings, pcm.sample_rate);
  return source;
}

SoundSource SoundSource::copying(const EncodedAudio& audio) {
  SoundSource source;
  source.audio_ = &audio;
  source.bit_rate_ = mean_bit_rate(audio);
  return source;
}

Result<void> SoundSource::refill() {
  constexpr std::size_t kBlock = 16384;
  coded_.clear();
  at_ = 0;
  while (coded_.empty() && !finished_) {
    const std::size_t count = std::min(kBlock, pcm_->samples.size() - pushed_);
    finished_ = count == 0;
    Result<std::vector<AudioPacket>> packets =
        finished_ ? encoder_->finish()
                  : encoder_->push(std::span(pcm_->samples).subspan(pushed_, count));
    if (!packets) return packets.error();
    pushed_ += count;
    coded_ = std::move(*packets);
  }
  return {};
}

// What lies behind the end of the sound is left out, and the last packet ends there.
const AudioPacket* SoundSource::next_copy() {
  if (at_ == audio_->packets.size()) return nullptr;
  const AudioPacket& packet = audio_->packets[at_];
  const std::int64_t end = audio_->length;
  if (end > 0 && packet.time >= end) return nullptr;
  ++at_;
  if (end <= 0 || packet.time + packet.duration <= end) return &packet;
  coded_ = {packet};
  coded_.front().duration = end - packet.time;
  return &coded_.front();
}

Result<const AudioPacket*> SoundSource::next() {
  if (audio_ != nullptr) return next_copy();
  if (at_ == coded_.size()) {
    Result<void> filled = refill();
    if (!filled) return filled.error();
  }
  return at_ < coded_.size() ? &coded_[at_++] : nullptr;
}

}  // namespace animeme::media
