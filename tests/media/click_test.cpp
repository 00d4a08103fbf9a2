// The click test: bursts at known samples must come back beside the planes they belong to.
// Source: containers, section 5.3.
#include <gtest/gtest.h>

#include "tests/media/media_support.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"
#include "tools/media/mux.h"

namespace animeme::media {
namespace {

struct Path {
  const char* extension;
  int sample_rate;
  double limit;  // seconds
};

std::string name(const testing::TestParamInfo<Path>& info) {
  return std::string(info.param.extension + 1) + "_" + std::to_string(info.param.sample_rate);
}

class Click : public testing::TestWithParam<Path> {};

TEST_P(Click, SoundAndFaceStayTogether) {
  const auto [extension, rate, limit] = GetParam();
  const test::TempDir dir;
  const std::string path = dir.file(std::string("talk") + extension);
  const fba::AccessUnits face = test::make_face(100);
  std::vector<std::size_t> starts;
  for (std::size_t k = 1; k < 8; ++k) starts.push_back(k * std::size_t(rate) / 2 + 37);
  const Pcm sound = test::make_clicks(rate, 4 * std::size_t(rate), starts);
  const Result<MuxResult> written = write_container(path, {.face = &face, .audio = &sound});
  ASSERT_TRUE(written) << written.error().describe();

  const Result<Container> back = read_container(path);
  ASSERT_TRUE(back) << back.error().describe();
  const Result<Pcm> decoded = read_audio(path);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(back->face.units.size(), face.units.size());
  // Both sides are asked for the same distance: from plane 0 to the burst.
  const double ticks = back->face.timescale;
  const double face_start = double(back->face.units[0].time) / ticks;
  for (const std::size_t start : starts) {
    const double wanted = double(start) / rate + face_start;
    const double near = wanted * decoded->sample_rate;
    const std::int64_t found = test::find_click(*decoded, std::int64_t(near), 3000);
    EXPECT_NEAR(double(found) / decoded->sample_rate, wanted, limit) << "burst at " << start;
  }
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    EXPECT_NEAR(double(back->face.units[i].time) / ticks - face_start, double(i) / 25, 0.00051);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Click,
                         testing::Values(Path{".mp4", 48000, 1.01 / 48000},
                                         Path{".mp4", 44100, 1.01 / 44100},
                                         Path{".mp4", 16000, 1.01 / 16000},
                                         Path{".mp4", 22050, 1.01 / 22050},
                                         Path{".mp4", 20000, 1.01 / 20000},
                                         Path{".mkv", 48000, 0.001}, Path{".mkv", 16000, 0.001},
                                         Path{".ts", 48000, 0.001}, Path{".ts", 16000, 0.001}),
                         name);

TEST(ClickMp4, LengthIsThatOfTheSound) {
  const test::TempDir dir;
  for (const std::size_t length : {48000u, 47999u, 1024u, 1u, 100000u}) {
    const Pcm sound = test::make_clicks(48000, length, {0});
    ASSERT_TRUE(write_mp4(dir.file("a.mp4"), {.audio = &sound}));
    const Result<Pcm> back = read_audio(dir.file("a.mp4"));
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(back->samples.size(), length);
  }
}

// The same by another program, which knows nothing of our reader.
TEST(ClickMp4, FfmpegHearsTheBurstsInPlace) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(50);
  const Pcm sound = test::make_clicks(48000, 96000, {24000, 48000, 72000});
  ASSERT_TRUE(write_mp4(dir.file("a.mp4"), {.face = &face, .audio = &sound}));
  test::run("ffmpeg -v quiet -i " + dir.file("a.mp4") + " -vn " + dir.file("a.wav"));
  const Result<Pcm> decoded = read_audio(dir.file("a.wav"));
  ASSERT_TRUE(decoded) << decoded.error().describe();
  for (const std::int64_t start : {24000, 48000, 72000}) {
    EXPECT_NEAR(double(test::find_click(*decoded, start, 3000)), double(start), 1.0);
  }
}

}  // namespace
}  // namespace animeme::media
