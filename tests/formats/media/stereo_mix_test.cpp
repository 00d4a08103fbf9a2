// Two channels to one, also where their mean would be silence.
#include "tools/formats/media/detail/sound/stereo_mix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/wav_bytes.h"
#include "tools/formats/media/audio.h"

namespace animeme::media {
namespace stereo_mix_test {

constexpr int kRate = 16000;

std::vector<float> voice(std::size_t count) {
  std::vector<float> samples;
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(0.3f * std::sin(0.05f * float(i)) * std::sin(0.0007f * float(i)));
  }
  return samples;
}

std::vector<float> pairs(const std::vector<float>& left, float right) {
  std::vector<float> out;
  for (const float one : left) {
    out.push_back(one);
    out.push_back(right * one);
  }
  return out;
}

double power(const std::vector<float>& samples) {
  double sum = 0;
  for (const float one : samples) sum += double(one) * double(one);
  return sum / double(samples.size());
}

TEST(StereoMix, IsTheMean) {
  const auto left = voice(kRate);
  for (const float right : {1.0f, 0.5f, 0.0f, -0.3f}) {
    std::vector<float> mixed;
    StereoMix(kRate).mix(pairs(left, right), mixed);
    ASSERT_EQ(mixed.size(), left.size());
    for (std::size_t i = 0; i < left.size(); ++i)
      ASSERT_NEAR(mixed[i], 0.5f * (1 + right) * left[i], 1e-6f) << right;
  }
}

TEST(StereoMix, TakesOneOfOppositeChannelsHoweverTheyAreCut) {
  const auto left = voice(2 * kRate);
  for (const float right : {-1.0f, -0.95f, -1.1f}) {
    const auto both = pairs(left, right);
    std::vector<float> mixed, cut;
    StereoMix(kRate).mix(both, mixed);
    EXPECT_NEAR(power(mixed) / power(left), 1, 0.02) << right;
    StereoMix mix(kRate);
    for (std::size_t at = 0; at < both.size(); at += 2 * 37) {
      mix.mix(std::span(both).subspan(at, std::min<std::size_t>(2 * 37, both.size() - at)), cut);
    }
    EXPECT_EQ(mixed, cut);
  }
}

// A file with opposite channels of 16 bit, read as any other.
TEST(StereoMix, IsUsedForFiles) {
  const auto left = voice(kRate);
  std::vector<float> right;
  for (const float one : left) right.push_back(-one);
  const test::Bytes file = test::wav_bytes(kRate, {left, right});
  for (const int rate : {0, 8000}) {
    const auto pcm = read_audio(file, {.sample_rate = rate});
    ASSERT_TRUE(pcm) << pcm.error().describe();
    EXPECT_NEAR(power(pcm->samples) / power(left), 1, 0.05);
  }
}

}  // namespace stereo_mix_test
}  // namespace animeme::media
