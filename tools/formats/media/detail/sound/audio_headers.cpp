#include "tools/formats/media/detail/sound/audio_headers.h"

#include "codec/syntax/bits.h"

namespace animeme::media {

// Source: ISO/IEC 14496-3 section 1.6.2.1, as far as AAC without extensions goes.
std::optional<AacFacts> read_aac_config(std::span<const std::uint8_t> config) {
  constexpr std::uint32_t kEscape = 31;
  constexpr std::uint32_t kOwnRate = 15;
  fba::BitReader in(config);
  std::uint32_t type = in.bits(5);
  if (type == kEscape) type = 32 + in.bits(6);
  if (in.bits(4) == kOwnRate) in.bits(24);
  AacFacts facts;
  facts.channels = aac_channels(in.bits(4));
  if (in.bit() != 0) facts.frame_samples = 960;
  if (in.overrun() || type == 0) return std::nullopt;
  return facts;
}

std::optional<Adts> read_adts(std::span<const std::uint8_t> at) {
  if (at.size() < kAdtsHeader || at[0] != 0xFF || (at[1] & 0xF6) != 0xF0) return {};
  Adts frame;
  frame.object_type = 1 + (at[2] >> 6);
  frame.rate_index = at[2] >> 2 & 15;
  frame.channels = (at[2] & 1u) << 2 | at[3] >> 6;
  frame.size = std::size_t(at[3] & 3) << 11 | std::size_t(at[4]) << 3 | at[5] >> 5;
  const std::size_t blocks = 1 + (at[6] & 3u);
  if ((at[1] & 1) == 0) frame.header += 2 * blocks;  // checksums
  const bool usable = frame.rate_index < kAacRates.size() && frame.channels > 0 && blocks == 1 &&
                      frame.size > frame.header;
  return usable ? std::optional(frame) : std::nullopt;
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
