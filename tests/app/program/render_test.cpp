// animeme render: stills and contact sheets, run as a user does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/png_reader.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace render_test {

using test::animeme;
using test::Bytes;
using test::TempDir;
using ::testing::HasSubstr;

struct Picture {
  int width = 0;
  int height = 0;
  Bytes rgb;
};

Picture read_picture(const std::string& path) {
  const std::string file = test::slurp(path);
  Picture picture;
  picture.rgb = test::decode_png(Bytes(file.begin(), file.end()), picture.width, picture.height);
  EXPECT_FALSE(picture.rgb.empty()) << path;
  return picture;
}

std::string clip() { return (test::data_dir() / "fap" / "plain.fap").string(); }

Picture draw(const TempDir& dir, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"-o", dir / "out.png"});
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_picture(dir / "out.png");
}

// Compilers and libraries of mathematics differ in the last bits, which may move a sample over an
// edge here and there; a picture of something else differs far more.
void expect_alike(const Picture& a, const Picture& b) {
  ASSERT_EQ(a.rgb.size(), b.rgb.size());
  double sum = 0;
  int far = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int d = std::abs(int(a.rgb[i]) - int(b.rgb[i]));
    sum += d;
    far += d > 12 ? 1 : 0;
  }
  EXPECT_LT(sum / double(a.rgb.size()), 0.25);
  EXPECT_LT(far, int(a.rgb.size() / 200));
}

// The stored pictures are made by
//   animeme render --shapes expressions --size 72x72 --view three-quarter
//     -o tests/data/render/woman_expressions.png
//   animeme render --shapes visemes --size 56x56 --zoom 1.5 --head man
//     -o tests/data/render/man_visemes.png
//   animeme render --shapes expressions --size 56x56 --head child --view -60
//     -o tests/data/render/child_expressions.png
TEST(Render, PicturesAreThoseOfBefore) {
  const TempDir dir;
  const std::filesystem::path stored = test::data_dir() / "render";
  expect_alike(draw(dir, {"--shapes", "expressions", "--size", "72x72", "--view", "three-quarter"}),
               read_picture(stored / "woman_expressions.png"));
  expect_alike(
      draw(dir, {"--shapes", "visemes", "--size", "56x56", "--zoom", "1.5", "--head", "man"}),
      read_picture(stored / "man_visemes.png"));
  expect_alike(
      draw(dir, {"--shapes", "expressions", "--size", "56x56", "--head", "child", "--view=-60"}),
      read_picture(stored / "child_expressions.png"));
}

TEST(Render, StillsAndSheetsHaveTheirSizes) {
  const TempDir dir;
  const Picture still = draw(dir, {clip(), "--frame", "0", "--size", "60x40"});
  EXPECT_EQ(still.width, 60);
  EXPECT_EQ(still.height, 40);
  const Picture sheet = draw(dir, {clip(), "--sheet", "3x2", "--size", "40x40"});
  EXPECT_EQ(sheet.width, 3 * 40 + 2 * 2);
  EXPECT_EQ(sheet.height, 2 * 40 + 2);
  const Picture times = draw(dir, {clip(), "--time", "0,0.04", "--size", "40x40"});
  EXPECT_EQ(times.width, 2 * 40 + 2);
}

// Above the shoulders the edges show what is behind the head, in pictures for phones, too.
TEST(Render, NarrowPicturesCutNoHair) {
  const TempDir dir;
  for (const char* head : {"woman", "man", "child"}) {
    const Picture wide = draw(dir, {clip(), "--frame", "0", "--size", "160x96", "--head", head});
    for (const char* size : {"54x96", "40x96", "71x96"}) {
      const Picture narrow = draw(dir, {clip(), "--frame", "0", "--size", size, "--head", head});
      for (int y = 0; y < narrow.height / 2; ++y) {
        for (const int x : {0, narrow.width - 1}) {
          for (int c = 0; c < 3; ++c) {
            const int is = narrow.rgb[std::size_t((y * narrow.width + x) * 3 + c)];
            const int behind = wide.rgb[std::size_t(y * wide.width * 3 + c)];
            ASSERT_NEAR(is, behind, 8) << head << " " << size << " at " << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST(Render, FramesAndViewsDiffer) {
  const TempDir dir;
  const std::string high = (test::data_dir() / "fap" / "high_level.fap").string();
  const Picture front = draw(dir, {clip(), "--frame", "0", "--size", "60x60"});
  const Picture again = draw(dir, {clip(), "--time", "0", "--size", "60x60"});
  EXPECT_EQ(front.rgb, again.rgb);
  EXPECT_NE(front.rgb,
            draw(dir, {clip(), "--frame", "0", "--size", "60x60", "--view", "side"}).rgb);
  EXPECT_NE(front.rgb, draw(dir, {clip(), "--frame", "0", "--size", "60x60", "--head", "man"}).rgb);
  draw(dir, {high, "--frame", "0", "--size", "60x60"});
}

TEST(Render, JpegAndWebp) {
  const TempDir dir;
  const auto begins = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", clip(), "-o", dir / name, "--size", "60x60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return test::slurp(dir / name);
  };
  EXPECT_EQ(begins("a.jpg", {"--frame", "0"}).substr(0, 3), "\xFF\xD8\xFF");
  const std::string still = begins("a.webp", {"--frame", "0"}), moving = begins("b.webp", {});
  for (const std::string& file : {still, moving}) EXPECT_EQ(file.substr(8, 4), "WEBP");
  EXPECT_EQ(still.find("ANIM"), std::string::npos);
  EXPECT_NE(moving.find("ANMF"), std::string::npos);
  EXPECT_EQ(begins("c.gif", {}).substr(0, 6), "GIF89a");
  EXPECT_EQ(animeme({"render", clip(), "--frame", "0", "-o", dir / "d.gif"}).exit_code, 2);
  EXPECT_EQ(animeme({"render", clip(), "--background", "none", "-o", dir / "e.gif"}).exit_code, 2);
}

TEST(Render, ContainersAreFaces) {
  const TempDir dir;
  const auto movie = test::data_dir() / "containers" / "std_aac.mp4";
  const Picture sheet = draw(dir, {movie.string(), "--sheet", "2x1", "--size", "50x50"});
  EXPECT_EQ(sheet.width, 102);
}

TEST(Render, SaysWhatIsWrong) {
  const TempDir dir;
  const std::string out = dir / "out.png";
  const auto usage = [&](const std::vector<std::string>& arguments, const char* text) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  usage({"render", "-o", out}, "give a file to show");
  usage({"render", clip(), "--shapes", "visemes", "-o", out}, "give a file to show");
  usage({"render", "--shapes", "vowels", "-o", out}, "--shapes: vowels not in {visemes,");
  usage({"render", clip(), "--size", "640", "-o", out}, "--size: write WIDTHxHEIGHT");
  usage({"render", clip(), "--size", "0x4", "-o", out}, "--size: write WIDTHxHEIGHT");
  usage({"render", clip(), "--sheet", "4", "-o", out}, "--sheet: write COLUMNSxROWS");
  usage({"render", clip(), "--sheet", "100x4", "-o", out}, "larger than 8192 pixels");
  usage({"render", clip(), "--head", "dragon", "-o", out}, "--head is woman, man, child");
  usage({"render", clip(), "--view", "behind", "-o", out}, "--view: write front");
  usage({"render", clip(), "-o", dir / "out.bmp"}, "must end in .png");
  usage({"render", clip(), "--frame", "1", "--sheet", "2x2", "-o", out}, "--sheet");
  const auto input = [&](const std::vector<std::string>& arguments, const char* text) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  input({"render", dir / "none.fap", "-o", out}, "none.fap");
  input({"render", clip(), "--frame", "100000", "-o", out}, "there is no frame 100000");
  input({"render", clip(), "--time", "1e6", "-o", out}, "there is no frame at");
  EXPECT_TRUE(dir.files().empty());
}

}  // namespace render_test
}  // namespace animeme
