// What the bytes of AAC and Opus say: their configurations and what is in front of their frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace animeme::media {

/// Sample rates by their index (14496-3, samplingFrequencyIndex).
inline constexpr std::array<int, 13> kAacRates = {96000, 88200, 64000, 48000, 44100, 32000, 24000,
                                                  22050, 16000, 12000, 11025, 8000,  7350};

/// Channels of a channelConfiguration; 0: in a program element of its own.
constexpr int aac_channels(unsigned configuration) {
  return configuration == 7 ? 8 : int(configuration);
}

/// What an AudioSpecificConfig says. nullopt: not AAC, or too short.
struct AacFacts {
  int frame_samples = 1024;
  int channels = 0;  // 0: in the config's own program element
};
std::optional<AacFacts> read_aac_config(std::span<const std::uint8_t> config);

inline constexpr std::size_t kAdtsHeader = 7;  ///< bytes, without checksums

/// Header of an AAC frame (14496-3, adts_frame). nullopt: none, or of a frame that is not used:
/// several blocks, channels in a program element.
struct Adts {
  unsigned object_type = 2, rate_index = 0, channels = 1;
  std::size_t header = kAdtsHeader, size = 0;  ///< size with the header
};
std::optional<Adts> read_adts(std::span<const std::uint8_t> at);

/// Samples at 48 kHz in an Opus packet (RFC 6716, section 3.1); 0: not a legal packet.
int opus_samples(std::span<const std::uint8_t> packet);

/// OpusHead (RFC 7845, section 5.1).
std::vector<std::uint8_t> opus_head(int channels, int pre_skip, unsigned gain = 0);

}  // namespace animeme::media
