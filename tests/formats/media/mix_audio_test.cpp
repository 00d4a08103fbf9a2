#include "tools/formats/media/mix_audio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/temp_dir.h"
#include "tools/formats/media/audio.h"

namespace animeme::media {
namespace mix_audio_test {

Pcm level(float value, int rate, double seconds) {
  return {rate, std::vector<float>(std::size_t(seconds * rate), value)};
}

TEST(MixAudio, AddsWhatBeginsTogether) {
  const test::TempDir dir;
  const std::string a = dir.file("a.wav"), b = dir.file("b.wav"), out = dir.file("out.wav");
  ASSERT_TRUE(write_wav(a, level(0.25f, 16000, 1)));
  ASSERT_TRUE(write_wav(b, level(0.5f, 32000, 2)));
  const MixPart parts[] = {{a}, {b}};
  const auto done = mix_audio(out, parts);
  ASSERT_TRUE(done) << done.error().describe();
  const auto mixed = read_audio(out);
  ASSERT_TRUE(mixed);
  EXPECT_EQ(mixed->sample_rate, 32000);
  ASSERT_NEAR(double(mixed->samples.size()), 64000, 2);
  EXPECT_NEAR(mixed->samples[16000], 0.75, 0.01);
  EXPECT_NEAR(mixed->samples[48000], 0.5, 0.001) << "the longer one goes on alone";
}

TEST(MixAudio, LoudSumsAreLimited) {
  const test::TempDir dir;
  const std::string a = dir.file("a.wav"), out = dir.file("out.wav");
  ASSERT_TRUE(write_wav(a, level(0.9f, 8000, 1)));
  const MixPart parts[] = {{a}, {a}};
  ASSERT_TRUE(mix_audio(out, parts));
  const auto mixed = read_audio(out);
  ASSERT_TRUE(mixed);
  EXPECT_GT(mixed->samples[4000], 0.95);
  EXPECT_LT(mixed->samples[4000], 1.0);
}

TEST(MixAudio, RefusesNothing) {
  const test::TempDir dir;
  EXPECT_EQ(mix_audio(dir.file("out.wav"), {}).error().code, Code::invalid_argument);
  const MixPart parts[] = {{dir.file("missing.wav")}};
  EXPECT_EQ(mix_audio(dir.file("out.wav"), parts).error().code, Code::not_found);
}

}  // namespace mix_audio_test
}  // namespace animeme::media
