// Animated GIFs, read by a plain decoder of the test's own.
#include "tools/view/studio/gif.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace animeme::studio {
namespace gif_test {

using Bytes = std::vector<std::uint8_t>;

struct Shown {
  int delay = 0;  // hundredths of a second
  int width = 0, height = 0;
  std::size_t colours = 0;  // of its palette, with those that are not used
  Bytes rgb;                // the whole picture
};

// As the specification describes it: strings by their prefixes.
Bytes unpacked(const Bytes& codes, int index_bits, std::size_t pixels) {
  const int clear = 1 << index_bits;
  std::vector<Bytes> strings;
  Bytes out;
  int bits = index_bits + 1;
  std::optional<int> before;
  std::size_t at = 0;
  const auto restart = [&] {
    strings.assign(std::size_t(clear) + 2, {});
    for (int i = 0; i < clear; ++i) strings[std::size_t(i)] = {std::uint8_t(i)};
    bits = index_bits + 1;
    before.reset();
  };
  restart();
  while (at + std::size_t(bits) <= codes.size() * 8) {
    int code = 0;
    for (int i = 0; i < bits; ++i, ++at) code |= (codes[at / 8] >> (at % 8) & 1) << i;
    if (code == clear + 1) break;
    if (code == clear) {
      restart();
      continue;
    }
    Bytes string;
    if (std::size_t(code) < strings.size()) {
      string = strings[std::size_t(code)];
    } else {
      EXPECT_TRUE(before && std::size_t(code) == strings.size());
      if (!before || std::size_t(code) != strings.size()) return out;
      string = strings[std::size_t(*before)];
      string.push_back(string[0]);
    }
    out.insert(out.end(), string.begin(), string.end());
    if (before && strings.size() < 4096) {
      Bytes more = strings[std::size_t(*before)];
      more.push_back(string[0]);
      strings.push_back(more);
    }
    if (strings.size() == std::size_t(1) << bits && bits < 12) ++bits;
    before = code;
  }
  EXPECT_EQ(out.size(), pixels);
  return out;
}

std::vector<Shown> read_gif(const Bytes& file) {
  const auto word = [&](std::size_t at) { return file[at] | file[at + 1] << 8; };
  std::vector<Shown> pictures;
  EXPECT_EQ(std::string(file.begin(), file.begin() + 6), "GIF89a");
  const int width = word(6), height = word(8);
  Bytes canvas(std::size_t(width) * std::size_t(height) * 3);
  std::size_t at = 13;
  int delay = 0, transparent = -1;
  while (at < file.size() && file[at] != 0x3B) {
    if (file[at] == 0x21) {
      if (file[at + 1] == 0xF9) {
        delay = word(at + 4);
        transparent = (file[at + 3] & 1) != 0 ? file[at + 6] : -1;
      }
      at += 2;
      while (file[at] != 0) at += file[at] + 1U;
      ++at;
      continue;
    }
    EXPECT_EQ(file[at], 0x2C);
    const int x0 = word(at + 1), y0 = word(at + 3), w = word(at + 5), h = word(at + 7);
    const std::size_t colours = std::size_t(2) << (file[at + 9] & 7);
    const std::size_t palette = at + 10;
    at = palette + 3 * colours;
    const int index_bits = file[at++];
    Bytes codes;
    while (file[at] != 0) {
      codes.insert(codes.end(), file.begin() + std::ptrdiff_t(at) + 1,
                   file.begin() + std::ptrdiff_t(at) + 1 + file[at]);
      at += file[at] + 1U;
    }
    ++at;
    const Bytes indices = unpacked(codes, index_bits, std::size_t(w) * std::size_t(h));
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] == transparent) continue;
      const std::size_t x = std::size_t(x0) + i % std::size_t(w);
      const std::size_t y = std::size_t(y0) + i / std::size_t(w);
      std::memcpy(&canvas[3 * (y * std::size_t(width) + x)], &file[palette + 3U * indices[i]], 3);
    }
    pictures.push_back({delay, w, h, colours, canvas});
  }
  EXPECT_EQ(at + 1, file.size());
  return pictures;
}

// A face of a kind: a gradient with a dark ellipse that opens.
Bytes face(int width, int height, double open) {
  Bytes rgba;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double dx = (x - width / 2.0) / (0.2 * width);
      const double dy = (y - 0.7 * height) / (0.02 + 0.12 * open) / height;
      const bool mouth = dx * dx + dy * dy < 1;
      const int light = 120 + 100 * y / height;
      rgba.push_back(mouth ? 60 : std::uint8_t(light));
      rgba.push_back(mouth ? 20 : std::uint8_t(light * 3 / 4));
      rgba.push_back(mouth ? 20 : std::uint8_t(light / 2 + x * 40 / width));
      rgba.push_back(255);
    }
  }
  return rgba;
}

double error_of(const Shown& shown, const Bytes& rgba) {
  double sum = 0;
  for (std::size_t i = 0; i < shown.rgb.size(); ++i)
    sum += std::pow(double(shown.rgb[i]) - rgba[i / 3 * 4 + i % 3], 2);
  return std::sqrt(sum / double(shown.rgb.size()));
}

TEST(Gif, ShowsItsPictures) {
  Gif gif(120, 90);
  std::vector<Bytes> pictures;
  for (int i = 0; i < 12; ++i) {
    pictures.push_back(face(120, 90, std::abs(std::sin(0.6 * i))));
    ASSERT_TRUE(gif.push(pictures.back(), 40 * i));
  }
  const auto file = gif.finish(480);
  ASSERT_TRUE(file) << file.error().describe();
  const std::vector<Shown> shown = read_gif(*file);
  ASSERT_EQ(shown.size(), pictures.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(shown[i].delay, 4);
    EXPECT_LT(error_of(shown[i], pictures[i]), 5) << i;
    // Only the mouth is coded again.
    if (i > 0) {
      EXPECT_LT(shown[i].height, 45);
    }
  }
}

// What stays is not coded, and times are kept.
TEST(Gif, StillPicturesLastLonger) {
  Gif gif(40, 40);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(gif.push(face(40, 40, i < 20 ? 0.5 : 0.9), 40 * i));
  const auto file = gif.finish(1200);
  ASSERT_TRUE(file);
  const std::vector<Shown> shown = read_gif(*file);
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].delay, 80);
  EXPECT_EQ(shown[1].delay, 40);
}

// Players stretch pictures of less than 0.02 s.
TEST(Gif, FastFilmsKeepTheirDuration) {
  Gif gif(30, 30);
  int last = 0;
  for (int i = 0; i < 120; ++i) {
    last = int(std::lround(i * 1000 / 60.0));
    ASSERT_TRUE(gif.push(face(30, 30, i % 7 / 7.0), last));
  }
  const auto file = gif.finish(2000);
  ASSERT_TRUE(file);
  int sum = 0;
  for (const Shown& one : read_gif(*file)) {
    EXPECT_GE(one.delay, 2);
    sum += one.delay;
  }
  EXPECT_EQ(sum, 200);
}

// Every colour and length of strings: noise fills the table of codes many times.
TEST(Gif, NoiseIsReadBack) {
  std::mt19937 random(3);
  for (const int colours : {1, 2, 5, 255}) {
    for (const int side : {1, 2, 67, 150}) {
      Bytes rgba(std::size_t(side * side) * 4, 255);
      for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
        const auto one = unsigned(random() % unsigned(colours));
        rgba[i] = std::uint8_t(one % 16 * 16);
        rgba[i + 1] = std::uint8_t(one / 16 * 16);
        rgba[i + 2] = 8;
      }
      Gif gif(side, side);
      ASSERT_TRUE(gif.push(rgba, 0));
      const auto file = gif.finish(100);
      ASSERT_TRUE(file);
      const std::vector<Shown> shown = read_gif(*file);
      ASSERT_EQ(shown.size(), 1u);
      EXPECT_EQ(error_of(shown[0], rgba), 0) << colours << " " << side;
    }
  }
}

TEST(Gif, FewerColoursAreSmaller) {
  const auto size = [](int quality) {
    Gif gif(100, 100, quality);
    std::size_t colours = 0;
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(gif.push(face(100, 100, i / 5.0), 40 * i));
    const auto file = gif.finish(200);
    for (const Shown& one : read_gif(*file)) colours = std::max(colours, one.colours);
    return std::pair(file->size(), colours);
  };
  EXPECT_LT(size(10).first, size(80).first);
  EXPECT_LE(size(10).second, 64u);
}

TEST(Gif, WhatCannotBe) {
  Gif gif(10, 10);
  EXPECT_FALSE(gif.push(Bytes(399), 0));
  EXPECT_FALSE(gif.finish(10));
  EXPECT_FALSE(Gif(20000, 1).push(Bytes(80000), 0));
}

}  // namespace gif_test
}  // namespace animeme::studio
