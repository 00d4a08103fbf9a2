#include "tools/view/studio/picture_file.h"

#include <gmock/gmock.h>
#include <webp/decode.h>

#include <cmath>

namespace animeme::studio {
namespace picture_file_test {

render::Image slope(int width, int height, int shift = 0) {
  render::Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.rgba.insert(image.rgba.end(),
                        {std::uint8_t(x * 2 + shift), std::uint8_t(y * 2), std::uint8_t(100), 255});
    }
  }
  return image;
}

TEST(PictureFile, WebpIsThePicture) {
  const render::Image image = slope(61, 33);
  const auto file = picture_of(image, ".webp", 90);
  ASSERT_TRUE(file) << file.error().describe();
  int width = 0, height = 0;
  std::uint8_t* pixels = WebPDecodeRGBA(file->data(), file->size(), &width, &height);
  ASSERT_NE(pixels, nullptr);
  ASSERT_EQ(width, 61);
  ASSERT_EQ(height, 33);
  double sum = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    sum += std::pow(double(image.rgba[i]) - pixels[i], 2);
  }
  WebPFree(pixels);
  EXPECT_LT(std::sqrt(sum / double(image.rgba.size())), 4);
}

TEST(PictureFile, JpegHasItsSizeAndFewBytes) {
  const auto fine = picture_of(slope(200, 120), ".jpg", 95);
  const auto coarse = picture_of(slope(200, 120), ".jpeg", 30);
  ASSERT_TRUE(fine && coarse);
  EXPECT_LT(coarse->size(), fine->size());
  // Start of image, JFIF; the frame header has height and width.
  EXPECT_EQ((*fine)[0], 0xFF);
  EXPECT_EQ((*fine)[1], 0xD8);
  const std::uint8_t header[] = {0xFF, 0xC0, 0x00, 0x11, 0x08, 0x00, 120, 0x00, 200, 3};
  EXPECT_NE(std::search(fine->begin(), fine->end(), std::begin(header), std::end(header)),
            fine->end());
}

TEST(PictureFile, AnimationsHaveTheirPicturesAndTimes) {
  auto animation = Animation::open(40, 30);
  ASSERT_TRUE(animation);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(animation->push(slope(40, 30, i * 30).rgba, i * 40));
  EXPECT_FALSE(animation->push(slope(41, 30).rgba, 160));
  const auto file = animation->finish(200);
  ASSERT_TRUE(file) << file.error().describe();
  // Chunks ANMF: 24 bits of duration behind place and size.
  const std::string text(file->begin(), file->end());
  std::vector<int> durations;
  for (std::size_t at = text.find("ANMF"); at != std::string::npos;
       at = text.find("ANMF", at + 1)) {
    durations.push_back(std::uint8_t(text[at + 20]) + 256 * std::uint8_t(text[at + 21]));
  }
  EXPECT_THAT(durations, testing::ElementsAre(40, 40, 40, 80));
}

TEST(PictureFile, WhatCannotBe) {
  EXPECT_EQ(picture_of(slope(4, 4), ".gif").error().code, Code::unsupported);
  EXPECT_EQ(picture_of({}, ".jpg").error().code, Code::invalid_argument);
  EXPECT_EQ(picture_of({4, 4, std::vector<std::uint8_t>(7)}, ".webp").error().code,
            Code::invalid_argument);
  EXPECT_EQ(picture_of({20000, 1, std::vector<std::uint8_t>(80000)}, ".webp").error().code,
            Code::invalid_argument);
  EXPECT_FALSE(Animation::open(0, 10));
  EXPECT_FALSE(Animation::open(10, 10, 0));
}

}  // namespace picture_file_test
}  // namespace animeme::studio
