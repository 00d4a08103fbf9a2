// PNG files: read back by zlib and by the rules of the format, independent of the writer.
#include "tools/view/render/png.h"

#include <gtest/gtest.h>
#include "tests/support/png_reader.h"

namespace animeme::test {
namespace png_test {

using render::Image;

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
    const Bytes rgb = decode_png(*png, width, height);
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

}  // namespace png_test
}  // namespace animeme::test
