// PNG, JPEG and WebP: right colours of good ones, an error of all others.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/picture_writer.h"
#include "tests/support/png_writer.h"
#include "tests/support/program.h"
#include "tools/view/gltf/detail/picture_decoder.h"

namespace animeme::gltf {
namespace pictures_test {

using test::Bytes;
using ::testing::HasSubstr;

constexpr int kWidth = 37;
constexpr int kHeight = 21;
constexpr std::int64_t kAll = 1 << 20;

// Slopes of colour, so that coding with loss keeps them; `channels` 1 to 4.
Bytes slopes(int width, int height, int channels) {
  Bytes out;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint8_t values[] = {
          std::uint8_t(40 + 150 * x / width), std::uint8_t(220 - 180 * y / height),
          std::uint8_t(60 + 80 * (x + y) / (width + height)), std::uint8_t(255 - 200 * x / width)};
      out.insert(out.end(), values, values + channels);
    }
  }
  return out;
}

DecodedPicture decoded(const Bytes& file, std::int64_t most = kAll) {
  auto picture = decode_picture(file, most);
  EXPECT_TRUE(picture) << picture.error().describe();
  return picture ? std::move(*picture) : DecodedPicture{};
}

std::string error_of_picture(const Bytes& file) {
  const auto picture = decode_picture(file, kAll);
  EXPECT_FALSE(picture);
  return picture ? "" : picture.error().message;
}

// Root mean square over all of `wanted`, rows of `channels`; 4 of what was decoded.
double distance(const DecodedPicture& is, const Bytes& wanted, std::size_t channels) {
  EXPECT_EQ(is.rgba.size() / 4, wanted.size() / channels);
  double sum = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const double off = is.rgba[i / channels * 4 + i % channels] - double(wanted[i]);
    sum += off * off;
  }
  return std::sqrt(sum / double(wanted.size()));
}

TEST(Pictures, PngOfEachKind) {
  for (const bool interlaced : {false, true}) {
    SCOPED_TRACE(interlaced);
    const Bytes rgba = slopes(kWidth, kHeight, 4);
    EXPECT_EQ(decoded(test::png_as(rgba, kWidth, kHeight, {.interlaced = interlaced})).rgba, rgba);
    const Bytes rgb = slopes(kWidth, kHeight, 3);
    const DecodedPicture plain = decoded(test::png_as(
        rgb, kWidth, kHeight, {.colour = PNG_COLOR_TYPE_RGB, .interlaced = interlaced}));
    EXPECT_EQ(distance(plain, rgb, 3), 0);
    EXPECT_EQ(plain.rgba[3], 255);
    const Bytes grey = slopes(kWidth, kHeight, 1);
    const DecodedPicture light = decoded(test::png_as(
        grey, kWidth, kHeight, {.colour = PNG_COLOR_TYPE_GRAY, .interlaced = interlaced}));
    for (std::size_t i = 0; i < grey.size(); ++i) {
      ASSERT_EQ(light.rgba[4 * i], grey[i]);
      ASSERT_EQ(light.rgba[4 * i + 2], grey[i]);
    }
    // Four bits: 0 1, 2 3.
    const DecodedPicture few = decoded(test::png_as({0x01, 0x23}, 2, 2,
                                                    {.colour = PNG_COLOR_TYPE_PALETTE,
                                                     .depth = 4,
                                                     .interlaced = interlaced,
                                                     .transparent = true}));
    EXPECT_EQ(few.rgba, (Bytes{0, 255, 0, 0, 1, 254, 7, 255, 2, 253, 14, 255, 3, 252, 21, 255}));
    const DecodedPicture deep = decoded(
        test::png_as({0x80, 0x80, 0xFF, 0xFF, 0, 0}, 1, 1,
                     {.colour = PNG_COLOR_TYPE_RGB, .depth = 16, .interlaced = interlaced}));
    EXPECT_EQ(deep.rgba, (Bytes{128, 255, 0, 255}));
  }
}

TEST(Pictures, JpegOfEachKind) {
  const Bytes rgb = slopes(kWidth, kHeight, 3);
  for (const bool progressive : {false, true}) {
    for (const bool full : {false, true}) {
      const Bytes file =
          test::jpeg_as(rgb, kWidth, kHeight, {.progressive = progressive, .full_colour = full});
      EXPECT_LT(distance(decoded(file), rgb, 3), full ? 1 : 3) << progressive;
    }
  }
  const Bytes grey = slopes(kWidth, kHeight, 1);
  EXPECT_LT(distance(decoded(test::jpeg_as(grey, kWidth, kHeight, {.components = 1})), grey, 1), 1);
  // Inks: all of cyan, half of black.
  Bytes inks;
  for (int i = 0; i < 64; ++i) inks.insert(inks.end(), {0, 255, 255, 128});
  const DecodedPicture print = decoded(test::jpeg_as(inks, 8, 8, {.components = 4}));
  EXPECT_NEAR(print.rgba[0], 0, 2);
  EXPECT_NEAR(print.rgba[1], 128, 2);
  EXPECT_EQ(print.rgba[3], 255);
}

TEST(Pictures, WebpOfEachKind) {
  const Bytes rgba = slopes(kWidth, kHeight, 4);
  EXPECT_EQ(decoded(test::webp_as(rgba, kWidth, kHeight, -1)).rgba, rgba);
  EXPECT_LT(distance(decoded(test::webp_as(rgba, kWidth, kHeight, 100)), rgba, 4), 3);
}

// A second decoder sees the same.
TEST(Pictures, AsFfmpegSeesThem) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is missing";
  const test::TempDir dir;
  const Bytes rgba = slopes(64, 48, 4), rgb = slopes(64, 48, 3);
  const std::pair<const char*, Bytes> files[] = {
      {"a.png", test::png_as(rgba, 64, 48, {})},
      {"b.jpg", test::jpeg_as(rgb, 64, 48, {.quality = 90})},
      {"c.jpg", test::jpeg_as(rgb, 64, 48, {.quality = 90, .progressive = true})},
      {"d.webp", test::webp_as(rgba, 64, 48, -1)},
      {"e.webp", test::webp_as(rgba, 64, 48, 90)}};
  for (const auto& [name, file] : files) {
    test::spill(dir / name, std::string(file.begin(), file.end()));
    const auto result = test::run_command({"ffmpeg", "-v", "error", "-i", dir / name, "-f",
                                           "rawvideo", "-pix_fmt", "rgba", dir / "raw"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string raw = test::slurp(dir / "raw");
    EXPECT_LT(distance(decoded(file), Bytes(raw.begin(), raw.end()), 4), 3) << name;
    std::remove((dir / "raw").c_str());
  }
}

TEST(Pictures, LargeOnesAreMadeSmallerAsTheyCome) {
  const Bytes rgba = slopes(64, 48, 4), rgb = slopes(64, 48, 3);
  const Bytes files[] = {test::png_as(rgba, 64, 48, {}),
                         test::png_as(rgba, 64, 48, {.interlaced = true}),
                         test::jpeg_as(rgb, 64, 48, {}), test::webp_as(rgba, 64, 48, -1)};
  for (const Bytes& file : files) {
    const DecodedPicture small = decoded(file, 64 * 48 / 16);
    ASSERT_EQ(small.width, 16);
    ASSERT_EQ(small.height, 12);
    Bytes wanted = slopes(16, 12, 3);
    EXPECT_LT(distance(small, wanted, 3), 10);
  }
  // What does not divide evenly has its last texels of what is left.
  const Bytes odd = slopes(5, 3, 4);
  const DecodedPicture small = decoded(test::png_as(odd, 5, 3, {}), 6);
  ASSERT_EQ(small.width, 3);
  ASSERT_EQ(small.height, 2);
  EXPECT_EQ(Bytes(small.rgba.end() - 4, small.rgba.end()), Bytes(odd.end() - 4, odd.end()));
}

TEST(Pictures, BrokenOnesAreErrors) {
  EXPECT_THAT(error_of_picture({1, 2, 3}), HasSubstr("neither PNG nor JPEG nor WebP"));
  EXPECT_THAT(error_of_picture(test::jpeg_with_too_many_symbols()), HasSubstr("it is damaged"));
  EXPECT_THAT(error_of_picture(test::jpeg_without_tables()), HasSubstr("it is damaged"));
  const Bytes rgba = slopes(kWidth, kHeight, 4), rgb = slopes(kWidth, kHeight, 3);
  const Bytes files[] = {test::png_as(rgba, kWidth, kHeight, {}),
                         test::png_as(rgba, kWidth, kHeight, {.interlaced = true}),
                         test::jpeg_as(rgb, kWidth, kHeight, {}),
                         test::jpeg_as(rgb, kWidth, kHeight, {.progressive = true}),
                         test::webp_as(rgba, kWidth, kHeight, -1),
                         test::webp_as(rgba, kWidth, kHeight, 80)};
  for (const Bytes& file : files) {
    for (std::size_t size = 0; size < file.size() * 3 / 4; size += 7) {
      const Bytes cut(file.begin(), file.begin() + std::ptrdiff_t(size));
      ASSERT_FALSE(decode_picture(cut, kAll)) << size << " of " << file.size();
    }
  }
}

// The header says how large it is, and nothing is decoded.
TEST(Pictures, LimitsAreKept) {
  const auto png = [](std::uint32_t width, std::uint32_t height) {
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    Bytes header;
    test::png::put(header, width);
    test::png::put(header, height);
    header.insert(header.end(), {8, 6, 0, 0, 0});
    test::png::chunk(file, "IHDR", header);
    test::png::chunk(file, "IDAT", {0});
    return file;
  };
  EXPECT_THAT(error_of_picture(png(8193, 8192)), HasSubstr("more than 8192 x 8192"));
  EXPECT_THAT(error_of_picture(png(16385, 1)), HasSubstr("16385 x 1 texels"));
  EXPECT_THAT(error_of_picture(png(0x7FFFFFFF, 0x7FFFFFFF)), HasSubstr("make it smaller"));
  EXPECT_EQ(size_of_picture(png(8192, 8192))->texels(), kMostTexels);
  // A progressive picture would lie in memory as a whole.
  Bytes jpeg = {0xFF, 0xD8};
  Bytes quantisation(65, 1);
  quantisation[0] = 0;
  test::jpeg::part(jpeg, 0xDB, quantisation);
  Bytes frame = {8, 0x20, 0, 0x20, 0, 3};
  for (const std::uint8_t id : Bytes{1, 2, 3}) frame.insert(frame.end(), {id, 0x11, 0});
  test::jpeg::part(jpeg, 0xC2, frame);
  test::jpeg::part(jpeg, 0xDA, {3, 1, 0, 2, 0, 3, 0, 0, 0, 0});
  jpeg.insert(jpeg.end(), {0, 0, 0, 0xFF, 0xD9});
  EXPECT_THAT(error_of_picture(jpeg), HasSubstr("not progressive"));
}

// Scans cost time, not bytes.
TEST(Pictures, ScansAreCounted) {
  Bytes file = test::jpeg_as(slopes(64, 48, 3), 64, 48, {.quality = 50, .separate = true});
  EXPECT_EQ(decoded(file).width, 64);
  std::size_t last = 0;
  for (std::size_t i = 0; i + 1 < file.size(); ++i) {
    if (file[i] == 0xFF && file[i + 1] == 0xDA) last = i;
  }
  const Bytes scan(file.begin() + std::ptrdiff_t(last), file.end() - 2);
  file.resize(file.size() - 2);
  for (int i = 0; i < 200; ++i) file.insert(file.end(), scan.begin(), scan.end());
  file.insert(file.end(), {0xFF, 0xD9});
  EXPECT_THAT(error_of_picture(file), HasSubstr("more than 100 scans"));
}

}  // namespace pictures_test
}  // namespace animeme::gltf
