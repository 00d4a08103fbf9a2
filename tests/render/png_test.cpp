// PNG files: read back by zlib and by the rules of the format, independent of the writer.
#include "tools/render/png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>

namespace animeme::test {
namespace {

using render::Image;
using Bytes = std::vector<std::uint8_t>;

std::uint32_t number(const Bytes& data, std::size_t at) {
  return std::uint32_t(data[at]) << 24 | std::uint32_t(data[at + 1]) << 16 |
         std::uint32_t(data[at + 2]) << 8 | data[at + 3];
}

// The RGB bytes of a PNG of 8 bits RGB; empty if anything is wrong.
Bytes decode(const Bytes& png, int& width, int& height) {
  static constexpr std::uint8_t kStart[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (png.size() < 8 || std::memcmp(png.data(), kStart, 8) != 0) return {};
  Bytes packed;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = number(png, at);
    if (at + 12 + size > png.size()) return {};
    const std::string type(png.begin() + std::ptrdiff_t(at + 4),
                           png.begin() + std::ptrdiff_t(at + 8));
    if (crc32(0, &png[at + 4], uInt(size + 4)) != number(png, at + 8 + size)) return {};
    if (type == "IHDR") {
      width = int(number(png, at + 8));
      height = int(number(png, at + 12));
      if (png[at + 16] != 8 || png[at + 17] != 2) return {};
    }
    if (type == "IDAT") packed.insert(packed.end(), &png[at + 8], &png[at + 8] + size);
    at += 12 + size;
  }
  const std::size_t line = std::size_t(width) * 3;
  Bytes rows((line + 1) * std::size_t(height));
  uLongf size = uLongf(rows.size());
  if (uncompress(rows.data(), &size, packed.data(), uLong(packed.size())) != Z_OK) return {};
  Bytes out(line * std::size_t(height));
  for (std::size_t y = 0; y < std::size_t(height); ++y) {
    for (std::size_t x = 0; x < line; ++x) {
      const int a = x >= 3 ? out[y * line + x - 3] : 0;
      const int b = y > 0 ? out[(y - 1) * line + x] : 0;
      const int c = x >= 3 && y > 0 ? out[(y - 1) * line + x - 3] : 0;
      const int p = a + b - c;
      const int nearest = std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c)
                              ? a
                          : std::abs(p - b) <= std::abs(p - c) ? b
                                                               : c;
      const int guesses[] = {0, a, b, (a + b) / 2, nearest};
      const std::uint8_t filter = rows[y * (line + 1)];
      if (filter > 4) return {};
      out[y * line + x] = std::uint8_t(rows[y * (line + 1) + 1 + x] + guesses[filter]);
    }
  }
  return out;
}

Image noise(int width, int height) {
  Image image{width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < width * height * 4; ++i) {
    state = state * 1664525u + 1013904223u;
    // Half of it smooth, so that different filters win.
    const bool smooth = i / (width * 4) % 2 == 0;
    image.rgba.push_back(i % 4 == 3 ? 255 : smooth ? std::uint8_t(i) : std::uint8_t(state >> 24));
  }
  return image;
}

TEST(Png, HoldsThePixels) {
  for (const auto& [w, h] : {std::pair(1, 1), {7, 5}, {64, 33}}) {
    const Image image = noise(w, h);
    const auto png = render::png_of(image);
    ASSERT_TRUE(png);
    int width = 0;
    int height = 0;
    const Bytes rgb = decode(*png, width, height);
    ASSERT_EQ(width, w);
    ASSERT_EQ(height, h);
    ASSERT_EQ(rgb.size(), std::size_t(w * h * 3));
    for (std::size_t i = 0; i < std::size_t(w * h); ++i) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(rgb[i * 3 + k], image.rgba[i * 4 + k]);
    }
  }
}

TEST(Png, RefusesWhatIsNoPicture) {
  EXPECT_EQ(render::png_of({}).error().code, Code::invalid_argument);
  EXPECT_EQ(render::png_of({2, 2, Bytes(15)}).error().code, Code::invalid_argument);
}

TEST(ContactSheet, PutsPicturesSideBySide) {
  std::vector<Image> pictures;
  for (int i = 0; i < 3; ++i) pictures.push_back({2, 1, Bytes(8, std::uint8_t(50 * (i + 1)))});
  const auto sheet = render::contact_sheet(pictures, 2, 1);
  ASSERT_TRUE(sheet);
  ASSERT_EQ(sheet->width, 5);
  ASSERT_EQ(sheet->height, 3);
  const auto red = [&](int x, int y) { return int(sheet->rgba[std::size_t(y * 5 + x) * 4]); };
  EXPECT_EQ(red(0, 0), 50);
  EXPECT_EQ(red(1, 0), 50);
  EXPECT_EQ(red(2, 0), 20);
  EXPECT_EQ(red(3, 0), 100);
  EXPECT_EQ(red(0, 2), 150);
  EXPECT_EQ(red(4, 2), 20);
  EXPECT_FALSE(render::contact_sheet({}, 2));
  EXPECT_FALSE(render::contact_sheet(pictures, 0));
  pictures[1].width = 1;
  EXPECT_FALSE(render::contact_sheet(pictures, 2));
}

}  // namespace
}  // namespace animeme::test
