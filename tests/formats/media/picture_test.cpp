// Drawings as PNG files.
#include "tools/formats/media/picture.h"

#include <gtest/gtest.h>

#include <string>

namespace animeme::media {
namespace picture_test {

constexpr const char* kDrawing =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"24\">"
    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>"
    "<rect x=\"4\" y=\"4\" width=\"8\" height=\"8\" fill=\"#ff0000\"/></svg>";

std::uint32_t big_endian(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
         std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

TEST(Picture, HasTheSizeOfTheDrawing) {
  const auto png = svg_to_png(kDrawing);
  if (!png && png.error().code == Code::unsupported) {
    GTEST_SKIP() << "this FFmpeg has no librsvg";
  }
  ASSERT_TRUE(png) << png.error().describe();
  ASSERT_GT(png->size(), 33u);
  EXPECT_EQ(std::string(png->begin() + 1, png->begin() + 4), "PNG");
  EXPECT_EQ(big_endian(*png, 16), 40u);
  EXPECT_EQ(big_endian(*png, 20), 24u);
  EXPECT_EQ((*png)[24], 8);  // bits
  EXPECT_EQ((*png)[25], 2);  // RGB
  EXPECT_EQ(*svg_to_png(kDrawing), *png);
  // Another colour gives other bytes: the drawing is in it.
  std::string green = kDrawing;
  green.replace(green.find("#ff0000"), 7, "#00ff00");
  EXPECT_NE(*svg_to_png(green), *png);
}

TEST(Picture, RefusesWhatIsNone) {
  EXPECT_FALSE(svg_to_png(""));
  EXPECT_FALSE(svg_to_png("this is no drawing"));
  EXPECT_FALSE(svg_to_png(std::string(kDrawing).substr(0, 100)));
}

}  // namespace picture_test
}  // namespace animeme::media
