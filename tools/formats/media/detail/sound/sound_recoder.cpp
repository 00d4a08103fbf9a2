#include "tools/formats/media/detail/sound/sound_recoder.h"

#include <algorithm>
#include <utility>

namespace animeme::media {

Result<SoundRecoder> SoundRecoder::open(const AudioFormat& format) {
  PacketDecoder decoder;
  if (auto opened = decoder.open(format); !opened) return opened.error();
  Result<AudioEncoder> encoder = AudioEncoder::open(format.sample_rate, {AudioCodec::aac});
  if (!encoder) return encoder.error();
  return SoundRecoder(std::move(decoder), std::move(*encoder), format.sample_rate);
}

Result<void> SoundRecoder::encode(std::span<const float> samples) {
  Result<std::vector<AudioPacket>> packets = encoder_.push(samples);
  if (!packets) return packets.error();
  next_ += std::int64_t(samples.size());
  std::move(packets->begin(), packets->end(), std::back_inserter(coded_));
  return {};
}

Result<void> SoundRecoder::code(std::int64_t at, std::span<const float> samples) {
  if (!begin_) {
    // What lies before time 0 is never heard.
    const auto skipped =
        std::size_t(std::clamp<std::int64_t>(-at, 0, std::int64_t(samples.size())));
    samples = samples.subspan(skipped);
    at += std::int64_t(skipped);
    if (samples.empty()) return {};
    begin_ = next_ = at;
  }
  const std::vector<float> silence(std::size_t(from_), 0.0F);
  while (next_ < at) {
    const auto count = std::size_t(std::min<std::int64_t>(at - next_, from_));
    if (auto done = encode({silence.data(), count}); !done) return done;
  }
  return encode(samples);
}

Result<std::vector<AudioPacket>> SoundRecoder::push(const AudioPacket& packet) {
  auto done = decoder_.decode(&packet, [this](std::int64_t at, std::span<const float> samples) {
    return code(at, samples);
  });
  if (!done) return done.error();
  // The encoder counts from the first sample that it was given.
  const std::int64_t shift = begin_.value_or(0) * format().sample_rate / from_;
  for (AudioPacket& each : coded_) each.time += shift;
  return std::exchange(coded_, {});
}

Result<std::vector<AudioPacket>> SoundRecoder::finish() {
  auto done = decoder_.decode(nullptr, [this](std::int64_t at, std::span<const float> samples) {
    return code(at, samples);
  });
  if (!done) return done.error();
  if (!begin_) return std::vector<AudioPacket>();
  Result<std::vector<AudioPacket>> packets = encoder_.finish();
  if (!packets) return packets.error();
  std::move(packets->begin(), packets->end(), std::back_inserter(coded_));
  const std::int64_t shift = begin_.value_or(0) * format().sample_rate / from_;
  for (AudioPacket& each : coded_) each.time += shift;
  return std::exchange(coded_, {});
}

}  // namespace animeme::media
