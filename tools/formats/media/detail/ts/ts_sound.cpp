#include "tools/formats/media/detail/ts/ts_sound.h"

#include "tools/formats/media/detail/sound/audio_headers.h"

namespace animeme::media {
namespace {

constexpr int kFrameSamples = 1024;

}  // namespace

TsSound::TsSound(TsCodec codec, int channels) : codec_(codec) {
  if (codec != TsCodec::opus) return;
  format_ = {.codec = AudioCodec::opus,
             .sample_rate = 48000,
             .channels = channels,
             .frame_samples = 0,
             .priming = 0,
             .config = opus_head(channels, 0)};
}

std::vector<AudioPacket> TsSound::push(std::span<const std::uint8_t> pes) {
  const bool continued = !rest_.empty();
  rest_.insert(rest_.end(), pes.begin(), pes.end());
  std::vector<AudioPacket> packets;
  if (codec_ == TsCodec::adts) push_adts(packets);
  if (codec_ == TsCodec::opus) push_opus(packets);
  std::int64_t time = continued && !packets.empty() ? -packets.front().duration : 0;
  for (AudioPacket& packet : packets) {
    packet.time = time;
    time += packet.duration;
  }
  return packets;
}

void TsSound::push_adts(std::vector<AudioPacket>& out) {
  std::size_t at = 0;
  while (rest_.size() - at >= kAdtsHeader) {
    const auto frame = read_adts(std::span(rest_).subspan(at));
    if (!frame) {
      ++at;
      ++damaged_;
      continue;
    }
    if (rest_.size() - at < frame->size) break;
    format_.sample_rate = kAacRates[frame->rate_index];
    format_.channels = aac_channels(frame->channels);
    format_.frame_samples = kFrameSamples;
    format_.config = {std::uint8_t(frame->object_type << 3 | frame->rate_index >> 1),
                      std::uint8_t((frame->rate_index & 1) << 7 | frame->channels << 3)};
    known_ = true;
    const auto begin = rest_.begin() + std::ptrdiff_t(at);
    out.push_back({{begin + std::ptrdiff_t(frame->header), begin + std::ptrdiff_t(frame->size)},
                   0,
                   kFrameSamples});
    at += frame->size;
  }
  rest_.erase(rest_.begin(), rest_.begin() + std::ptrdiff_t(at));
}

// A control header in front of each packet: 11 bits 0x3FF, three flags, size, trims, extension.
void TsSound::push_opus(std::vector<AudioPacket>& out) {
  std::span<const std::uint8_t> left(rest_);
  while (left.size() >= 3 && left[0] == 0x7F && (left[1] & 0xE0) == 0xE0) {
    const std::uint8_t flags = left[1];
    std::size_t at = 2, size = 0;
    while (at < left.size() && left[at] == 0xFF) size += left[at++];
    if (at < left.size()) size += left[at++];
    if ((flags & 0x10) != 0) at += 2;
    if ((flags & 0x08) != 0) at += 2;
    if ((flags & 0x04) != 0 && at < left.size()) at += 1 + std::size_t(left[at]);
    if (at > left.size() || left.size() - at < size) break;
    const auto packet = left.subspan(at, size);
    const int samples = opus_samples(packet);
    if (samples == 0) break;
    format_.frame_samples = !known_ || format_.frame_samples == samples ? samples : 0;
    known_ = true;
    out.push_back({{packet.begin(), packet.end()}, 0, samples});
    left = left.subspan(at + size);
  }
  if (!left.empty()) ++damaged_;
  rest_.clear();  // units never lie across PES packets
}

}  // namespace animeme::media
