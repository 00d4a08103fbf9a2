// A sound file of any number of channels, 16 bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tests/support/files.h"

namespace animeme::test {

/// All channels have the same length; values from -1 to 1.
inline Bytes wav_bytes(int sample_rate, const std::vector<std::vector<float>>& channels) {
  Bytes file;
  const auto word = [&](std::string_view text) {
    file.insert(file.end(), text.begin(), text.end());
  };
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) file.push_back(std::uint8_t(value >> (8 * i)));
  };
  const auto count = std::uint32_t(channels.size()), rate = std::uint32_t(sample_rate);
  const auto data = std::uint32_t(2 * count * channels[0].size());
  word("RIFF"), put(36 + data, 4), word("WAVEfmt "), put(16, 4), put(1, 2), put(count, 2);
  put(rate, 4), put(2 * count * rate, 4), put(2 * count, 2), put(16, 2), word("data"), put(data, 4);
  for (std::size_t i = 0; i < channels[0].size(); ++i) {
    for (const auto& channel : channels) put(std::uint32_t(std::lround(channel[i] * 32767)), 2);
  }
  return file;
}

}  // namespace animeme::test
