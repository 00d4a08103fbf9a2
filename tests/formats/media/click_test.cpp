// Face and sound stay together in every format that is offered.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/formats/media/click_measure.h"

namespace animeme::media {
namespace click_test {

class Click : public testing::TestWithParam<std::tuple<test::ClickPath, int>> {};

TEST_P(Click, SoundAndFaceStayTogether) {
  const auto& [way, rate] = GetParam();
  const test::TempDir dir;
  const auto offsets =
      test::measure_clicks(dir.file(std::string("talk") + way.extension), way, rate);
  ASSERT_TRUE(offsets) << offsets.error().describe();
  // Opus smears a burst by more than a sample, the same in every container.
  const double smear = way.codec == AudioCodec::opus ? 0.0005 : 0;
  const double limit = way.limit > 0 ? way.limit : smear + 1.01 / offsets->sample_rate;
  EXPECT_LE(std::abs(offsets->error), limit);
  EXPECT_LE(offsets->jitter, way.limit > 0 ? 0.00051 : 0);
}

INSTANTIATE_TEST_SUITE_P(Paths, Click,
                         testing::Combine(testing::ValuesIn(test::kClickPaths),
                                          testing::Values(48000, 44100, 16000, 22050, 20000)),
                         [](const auto& path) {
                           const test::ClickPath& way = std::get<0>(path.param);
                           std::string text = way.name;
                           std::erase_if(text, [](char c) { return c == ' ' || c == ','; });
                           return text + "_" + name_of(way.codec) + "_" +
                                  std::to_string(std::get<1>(path.param));
                         });

TEST(ClickMp4, LengthIsThatOfTheSound) {
  const test::TempDir dir;
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    for (const std::size_t length : {48000u, 47999u, 1024u, 1u, 100000u}) {
      for (const bool fragmented : {false, true}) {
        // libavformat's reader passes over Opus that ends within its pre-skip of 312 samples.
        if (codec == AudioCodec::opus && length < 312) continue;
        const Pcm sound = test::make_clicks(48000, length, {0});
        const MuxOptions options{.audio = {.codec = codec}, .fragmented = fragmented};
        ASSERT_TRUE(write_mp4(dir.file("a.mp4"), {.audio = &sound}, options));
        const Result<Pcm> back = read_audio(dir.file("a.mp4"));
        ASSERT_TRUE(back) << name_of(codec) << length << fragmented << back.error().describe();
        EXPECT_EQ(back->samples.size(), length) << name_of(codec) << " " << fragmented;
      }
    }
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

}  // namespace click_test
}  // namespace animeme::media
