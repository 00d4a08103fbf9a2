// Textures that are coded again for a page, decoded by libwebp.
#include "tools/view/studio/page_pictures.h"

#include <gtest/gtest.h>
#include <webp/decode.h>

namespace animeme::test {
namespace page_pictures_test {

// Colours that change slowly; the left half is transparent and keeps its colours.
std::shared_ptr<const head::Picture> picture_of(int side, std::size_t file_bytes) {
  head::Texels texels{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      texels.rgba.insert(texels.rgba.end(),
                         {std::uint8_t(200 * x / side), std::uint8_t(200 * y / side), 90,
                          std::uint8_t(x < side / 2 ? 0 : 255)});
    }
  }
  return std::make_shared<const head::Picture>(std::move(texels), head::TexelKind::colour,
                                               std::vector<std::uint8_t>(file_bytes, 7),
                                               "image/png");
}

TEST(PagePictures, LargeOnesBecomeSmaller) {
  head::Head head;
  head.materials.resize(3);
  head.materials[0].base.picture = head.materials[1].emissive.picture = picture_of(1500, 900'000);
  const auto small = head.materials[2].base.picture = picture_of(8, 100);
  EXPECT_EQ(studio::shrink_pictures(head), 1u);
  EXPECT_EQ(head.materials[2].base.picture, small);
  EXPECT_EQ(head.materials[1].emissive.picture, head.materials[0].base.picture);
  const head::Picture& now = *head.materials[0].base.picture;
  EXPECT_EQ(now.type(), "image/webp");
  EXPECT_LT(now.file().size(), 250'000u);
  int width = 0, height = 0;
  std::uint8_t* rgba = WebPDecodeRGBA(now.file().data(), now.file().size(), &width, &height);
  ASSERT_NE(rgba, nullptr);
  EXPECT_EQ(width, 750);
  EXPECT_EQ(height, 750);
  for (const auto& [x, y] : {std::pair(100, 600), {700, 100}, {300, 300}}) {
    const std::uint8_t* p = rgba + (y * width + x) * 4;
    EXPECT_NEAR(p[0], 200 * x / width, 6);
    EXPECT_NEAR(p[1], 200 * y / height, 6);
    EXPECT_NEAR(p[2], 90, 6);
    EXPECT_EQ(p[3], x < width / 2 ? 0 : 255);
  }
  WebPFree(rgba);
}

TEST(PagePictures, WhatGetsNoSmallerStays) {
  head::Head head;
  head.materials.resize(1);
  const auto before = head.materials[0].base.picture = picture_of(256, 60);
  EXPECT_EQ(studio::shrink_pictures(head, 50), 0u);
  EXPECT_EQ(head.materials[0].base.picture, before);
}

}  // namespace page_pictures_test
}  // namespace animeme::test
