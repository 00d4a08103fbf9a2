// Faces, clicks, folders and programs for the media tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/media/pcm.h"

namespace animeme::test {

namespace fs = std::filesystem;

inline const Bytes kFaceConfig = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47};

/// Units with legal headers and arbitrary plane data, start code emulations included. Every
/// `period`-th one is intra.
inline fba::AccessUnits make_face(int count, std::uint32_t timescale = 25000,
                                  std::int64_t duration = 1000, int period = 50) {
  fba::AccessUnits face;
  face.config = kFaceConfig;
  face.timescale = timescale;
  std::uint32_t state = 12345;
  for (int i = 0; i < count; ++i) {
    fba::AccessUnit unit;
    unit.intra = i % period == 0;
    unit.time = i * duration;
    unit.duration = duration;
    if (i == 0) unit.bytes = {0, 0, 1, 0xBA, 0x7F};
    unit.bytes.insert(unit.bytes.end(), {0, 0, 1, 0xBB});
    unit.bytes.push_back(unit.intra ? 0xB1 : 0x27);
    const int length = unit.intra ? 60 : 8 + i % 13;
    for (int k = 0; k < length; ++k) {
      state = state * 1664525u + 1013904223u;
      unit.bytes.push_back(std::uint8_t(state >> 24));
    }
    if (i % 7 == 3) unit.bytes.insert(unit.bytes.end(), {0, 0, 1, 0xBB, 0xFF});
    face.units.push_back(std::move(unit));
  }
  return face;
}

inline constexpr double kBurstSeconds = 0.005;
inline constexpr double kBurstHertz = 4000;

/// Silence with 5 ms bursts of 4 kHz that begin exactly at the given samples.
inline media::Pcm make_clicks(int sample_rate, std::size_t length,
                              const std::vector<std::size_t>& starts) {
  media::Pcm pcm{sample_rate, std::vector<float>(length)};
  const auto burst = std::size_t(kBurstSeconds * sample_rate);
  for (const std::size_t start : starts) {
    for (std::size_t i = 0; i < burst && start + i < length; ++i) {
      pcm.samples[start + i] = float(
          0.5 * std::sin(2 * std::numbers::pi * kBurstHertz * double(i) / double(sample_rate)));
    }
  }
  return pcm;
}

/// Sample at which a burst fits best, within +-`range` of `near` (matched filter).
inline std::int64_t find_click(const media::Pcm& pcm, std::int64_t near, std::int64_t range) {
  const media::Pcm burst =
      make_clicks(pcm.sample_rate, std::size_t(kBurstSeconds * pcm.sample_rate), {0});
  double best = -1;
  std::int64_t at = -1;
  for (std::int64_t start = std::max<std::int64_t>(0, near - range); start <= near + range;
       ++start) {
    double sum = 0;
    for (std::size_t i = 0; i < burst.samples.size(); ++i) {
      const std::size_t k = std::size_t(start) + i;
      if (k < pcm.samples.size()) sum += double(pcm.samples[k]) * double(burst.samples[i]);
    }
    if (sum > best) {
      best = sum;
      at = start;
    }
  }
  return at;
}

/// CRC-32 as ffprobe prints it.
inline std::uint32_t crc32(const Bytes& bytes) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  return ~crc;
}

/// Content of the first box with this path, e.g. "moov/iods"; empty: there is none. "stsd" and
/// its entries are walked into like plain boxes.
inline Bytes find_box(const Bytes& file, const std::string& path) {
  const std::string want = path.substr(0, 4);
  std::size_t at = 0;
  while (at + 8 <= file.size()) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | file[at + i];
    if (size < 8 || size > file.size() - at) return {};
    if (std::string(file.begin() + std::ptrdiff_t(at) + 4, file.begin() + std::ptrdiff_t(at) + 8) ==
        want) {
      std::size_t skip = 8;
      if (want == "stsd") skip += 8;
      if (want == "mp4v") skip += 78;
      if (want == "mp4s") skip += 8;
      if (want == "mp4a") skip += 28;
      if (path.size() <= 4) skip = 8;
      const Bytes content(file.begin() + std::ptrdiff_t(at + skip),
                          file.begin() + std::ptrdiff_t(at + size));
      if (path.size() <= 4) return content;
      const Bytes inner = find_box(content, path.substr(5));
      if (!inner.empty()) return inner;  // else: try the next track
    }
    at += size;
  }
  return {};
}

}  // namespace animeme::test
