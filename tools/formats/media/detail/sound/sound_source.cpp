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
  if (stored_ != nullptr) return double(length_) / format().sample_rate;
  return double(audio_->packets.back().time) / audio_->format.sample_rate;
}

double SoundSource::seconds_so_far() const {
  if (!copies()) {
    if (!reader_) return double(pushed_) / pcm_->sample_rate;
    return double(pushed_) / reader_->channels() / reader_->sample_rate();
  }
  const std::int64_t end = copied_until_;
  return double(length_ > 0 ? std::min(end, length_) : end) / format().sample_rate;
}

const AudioFormat& SoundSource::format() const {
  if (stored_ != nullptr) return stored_->format();
  return audio_ != nullptr ? audio_->format : encoder_->format();
}

SoundSource SoundSource::copying(const EncodedAudio& audio) {
  SoundSource source;
  source.audio_ = &audio;
  source.length_ = audio.length;
  source.bit_rate_ = mean_bit_rate(audio);
  return source;
}

Result<SoundSource> SoundSource::copying(StoredAudio& audio) {
  if (auto begun = audio.rewind(); !begun) return begun.error();
  SoundSource source;
  source.stored_ = &audio;
  source.length_ = audio.length();
  source.bit_rate_ = audio.bit_rate();
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
Result<const AudioPacket*> SoundSource::next_copy() {
  const AudioPacket* packet = nullptr;
  if (stored_ != nullptr) {
    const Result<const AudioPacket*> read = stored_->next();
    if (!read) return read;
    packet = *read;
  } else if (at_ < audio_->packets.size()) {
    packet = &audio_->packets[at_];
  }
  if (packet == nullptr || (length_ > 0 && packet->time >= length_)) return nullptr;
  ++at_;
  copied_until_ = packet->time + packet->duration;
  if (length_ <= 0 || copied_until_ <= length_) return packet;
  coded_ = {*packet};
  coded_.front().duration = length_ - packet->time;
  return &coded_.front();
}

Result<const AudioPacket*> SoundSource::next() {
  if (copies()) return next_copy();
  if (at_ == coded_.size()) {
    Result<void> filled = refill();
    if (!filled) return filled.error();
  }
  return at_ < coded_.size() ? &coded_[at_++] : nullptr;
}

}  // namespace animeme::media
