#include "tools/formats/media/detail/sound/sound_source.h"

#include <algorithm>
#include <utility>

#include "tools/formats/media/detail/sound/audio_parameters.h"

namespace animeme::media {

Result<SoundSource> SoundSource::coding(const Pcm& pcm, const AudioSettings& settings) {
  SoundSource source;
  source.pcm_ = &pcm;
  if (auto started = source.start(pcm.sample_rate, settings, 1); !started) return started.error();
  return source;
}

Result<SoundSource> SoundSource::decoding(const std::string& path, const AudioSettings& settings,
                                          std::vector<std::string>* warnings) {
  constexpr double kLongest = 24 * 3600;
  Result<AudioReader> reader =
      AudioReader::open(path, {.max_seconds = kLongest, .warnings = warnings, .most_channels = 2});
  if (!reader) return reader.error();
  SoundSource source;
  source.reader_.emplace(std::move(*reader));
  source.path_ = path;
  const int rate = source.reader_->sample_rate();
  const int channels = source.reader_->channels();
  if (auto started = source.start(rate, settings, channels); !started) return started.error();
  return source;
}

Result<void> SoundSource::start(int sample_rate, const AudioSettings& settings, int channels) {
  Result<AudioEncoder> encoder = AudioEncoder::open(sample_rate, settings, channels);
  if (!encoder) return encoder.error();
  encoder_.emplace(std::move(*encoder));
  bit_rate_ = coded_bit_rate(settings, sample_rate, channels);
  return {};
}

double SoundSource::seconds() const {
  if (pcm_ != nullptr) return pcm_->duration();
  if (reader_) return reader_->told_seconds();
  return double(audio_->packets.back().time) / audio_->format.sample_rate;
}

double SoundSource::seconds_so_far() const {
  if (audio_ == nullptr) {
    if (!reader_) return double(pushed_) / pcm_->sample_rate;
    return double(pushed_) / reader_->channels() / reader_->sample_rate();
  }
  if (at_ == 0) return 0;
  const AudioPacket& last = audio_->packets[at_ - 1];
  const std::int64_t end = last.time + last.duration;
  return double(audio_->length > 0 ? std::min(end, audio_->length) : end) /
         audio_->format.sample_rate;
}

SoundSource SoundSource::copying(const EncodedAudio& audio) {
  SoundSource source;
  source.audio_ = &audio;
  source.bit_rate_ = mean_bit_rate(audio);
  return source;
}

Result<std::span<const float>> SoundSource::more_samples() {
  constexpr std::size_t kBlock = 16384;
  if (pcm_ != nullptr) {
    const std::span<const float> rest = std::span(pcm_->samples).subspan(pushed_);
    return rest.first(std::min(kBlock, rest.size()));
  }
  Result<std::span<const float>> block = reader_->next();
  if (!block) return block.error().in_file(path_);
  return block;
}

Result<void> SoundSource::refill() {
  coded_.clear();
  at_ = 0;
  while (coded_.empty() && !finished_) {
    const Result<std::span<const float>> samples = more_samples();
    if (!samples) return samples.error();
    finished_ = samples->empty();
    Result<std::vector<AudioPacket>> packets =
        finished_ ? encoder_->finish() : encoder_->push(*samples);
    if (!packets) return packets.error();
    pushed_ += samples->size();
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
