#include "tools/view/studio/background.h"

#include <gmock/gmock.h>

#include "tests/support/temp_dir.h"
#include "tools/formats/files/files.h"
#include "tools/view/render/png.h"
#include "tools/view/studio/picture_file.h"

namespace animeme::studio {
namespace background_test {

using testing::HasSubstr;

std::uint32_t colour_of(std::string_view text) {
  const auto background = parse_background(text);
  EXPECT_TRUE(background) << text;
  EXPECT_EQ(background->kind, Background::Kind::colour) << text;
  return background ? background->colour : 0xDEAD000;
}

TEST(Background, ColoursAreReadAsInCss) {
  EXPECT_EQ(colour_of("#336699"), 0x336699u);
  EXPECT_EQ(colour_of("#fA0"), 0xFFAA00u);
  EXPECT_EQ(colour_of("white"), 0xFFFFFFu);
  EXPECT_EQ(colour_of("Lime"), 0x00FF00u);
  EXPECT_EQ(colour_of("grey"), colour_of("gray"));
}

TEST(Background, KindsAndWhatIsNone) {
  EXPECT_EQ(parse_background("none")->kind, Background::Kind::none);
  const auto picture = parse_background("my room.JPG");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->kind, Background::Kind::picture);
  EXPECT_EQ(picture->path, "my room.JPG");
  for (const std::string_view wrong :
       {"#12", "#12345", "#12345g", "#", "whit", "room.bmp", " ", ""}) {
    const auto read = parse_background(wrong);
    ASSERT_FALSE(read) << wrong;
    EXPECT_THAT(read.error().message, HasSubstr("is no background"));
  }
}

// Left half red, right half blue, all of it 40 x 10.
render::Image halves() {
  render::Image image{40, 10, {}};
  for (int i = 0; i < 400; ++i) {
    const bool left = i % 40 < 20;
    image.rgba.insert(image.rgba.end(),
                      {std::uint8_t(left ? 250 : 0), 10, std::uint8_t(left ? 0 : 240), 255});
  }
  return image;
}

TEST(Background, PicturesFillTheFrame) {
  const test::TempDir dir;
  for (const char* name : {"room.png", "room.jpg", "room.webp"}) {
    const auto file = picture_of(halves(), tools::extension_of(name), 95);
    ASSERT_TRUE(file);
    ASSERT_TRUE(tools::write_file(dir / name, *file));
    for (const auto& [width, height] :
         {std::pair{40, 10}, std::pair{20, 20}, std::pair{16, 64}, std::pair{7, 3}}) {
      const auto behind = picture_behind(*parse_background(dir / name), width, height);
      ASSERT_TRUE(behind) << behind.error().describe();
      ASSERT_NE(*behind, nullptr);
      const render::Image& image = **behind;
      ASSERT_EQ(image.width, width);
      ASSERT_EQ(image.height, height);
      ASSERT_EQ(image.rgba.size(), std::size_t(width * height) * 4);
      // Cut at both sides alike: the middle of the picture is in the middle of the frame.
      for (int y = 0; y < height; ++y) {
        const std::uint8_t* row = &image.rgba[std::size_t(y * width) * 4];
        EXPECT_NEAR(row[0], 250, 25) << name << " " << width;
        EXPECT_NEAR(row[2], 0, 30) << name << " " << width;
        EXPECT_NEAR(row[(width - 1) * 4], 0, 30) << name << " " << width;
        EXPECT_NEAR(row[(width - 1) * 4 + 2], 240, 25) << name << " " << width;
      }
    }
  }
  EXPECT_EQ(*picture_behind(*parse_background("none"), 8, 8), nullptr);
}

TEST(Background, PicturesThatAreNone) {
  const test::TempDir dir;
  EXPECT_EQ(picture_behind(*parse_background(dir / "gone.png"), 8, 8).error().code,
            Code::not_found);
  ASSERT_TRUE(tools::write_file(dir / "text.png", std::vector<std::uint8_t>(50, 'x')));
  const auto text = picture_behind(*parse_background(dir / "text.png"), 8, 8);
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().describe(), HasSubstr("text.png"));
  auto cut = *render::png_of(halves());
  cut.resize(40);
  ASSERT_TRUE(tools::write_file(dir / "cut.png", cut));
  EXPECT_FALSE(picture_behind(*parse_background(dir / "cut.png"), 8, 8));
  // A line that would have to grow to a picture of any size.
  const render::Image line{1, 16000, std::vector<std::uint8_t>(64000, 200)};
  ASSERT_TRUE(tools::write_file(dir / "line.png", *render::png_of(line)));
  const auto narrow = picture_behind(*parse_background(dir / "line.png"), 8000, 8);
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().code, Code::out_of_range);
}

}  // namespace background_test
}  // namespace animeme::studio
