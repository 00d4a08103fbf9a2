#include "tools/media/detail/ts_sound.h"

#include <array>
#include <optional>

namespace animeme::media {
namespace {

constexpr std::array<int, 13> kRates = {96000, 88200, 64000, 48000, 44100, 32000, 24000,
                                        22050, 16000, 12000, 11025, 8000,  7350};
constexpr std::size_t kAdtsHeader = 7;
constexpr int kFrameSamples = 1024;

struct Adts {
  unsigned object_type = 2, rate_index = 0, channels = 1;
  std::size_t header = kAdtsHeader, size = 0;  // size with the header
  int blocks = 1;
};

std::optional<Adts> read_adts(std::span<const std::uint8_t> at) {
  if (at.size() < kAdtsHeader || at[0] != 0xFF || (at[1] & 0xF6) != 0xF0) return {};
  Adts frame;
  frame.object_type = 1 + (at[2] >> 6);
  frame.rate_index = at[2] >> 2 & 15;
  frame.channels = (at[2] & 1u) << 2 | at[3] >> 6;
  frame.size = std::size_t(at[3] & 3) << 11 | std::size_t(at[4]) << 3 | at[5] >> 5;
  frame.blocks = 1 + (at[6] & 3);
  if ((at[1] & 1) == 0) frame.header += 2 * std::size_t(frame.blocks);  // checksums
  const bool usable = frame.rate_index < kRates.size() && frame.channels > 0 && frame.blocks == 1 &&
                      frame.size > frame.header;
  return usable ? std::optional(frame) : std::nullopt;
}

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
    format_.sample_rate = kRates[frame->rate_index];
    format_.channels = frame->channels == 7 ? 8 : int(frame->channels);
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

int opus_samples(std::span<const std::uint8_t> packet) {
  if (packet.empty()) return 0;
  const int config = packet[0] >> 3;
  int frame = 0;
  if (config < 12) {
    constexpr std::array<int, 4> kSilk = {480, 960, 1920, 2880};
    frame = kSilk[std::size_t(config % 4)];
  } else if (config < 16) {
    frame = config % 2 == 0 ? 480 : 960;
  } else {
    frame = 120 << config % 4;
  }
  const int code = packet[0] & 3;
  if (code == 3 && packet.size() < 2) return 0;
  const int frames = code == 0 ? 1 : code < 3 ? 2 : packet[1] & 63;
  const int samples = frame * frames;
  return samples <= 5760 ? samples : 0;
}

std::vector<std::uint8_t> opus_head(int channels, int pre_skip, unsigned gain) {
  std::vector<std::uint8_t> head = {'O', 'p', 'u', 's', 'H', 'e', 'a', 'd', 1};
  head.push_back(std::uint8_t(channels));
  head.push_back(std::uint8_t(pre_skip & 0xFF));
  head.push_back(std::uint8_t(pre_skip >> 8 & 0xFF));
  head.insert(head.end(), {0x80, 0xBB, 0, 0});  // 48000, little endian
  head.insert(head.end(), {std::uint8_t(gain), std::uint8_t(gain >> 8), 0});  // mapping family 0
  return head;
}

}  // namespace animeme::media
