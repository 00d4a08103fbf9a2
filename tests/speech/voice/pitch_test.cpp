#include "tools/speech/voice/pitch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace animeme::voice {
namespace pitch_test {

/// Pulses of a pitch that rises from one value to another, through two formants: a synthetic voice.
media::Pcm voiced(double from, double to, double seconds, int rate, double noise = 0) {
  media::Pcm sound;
  sound.sample_rate = rate;
  const auto count = std::size_t(seconds * rate);
  double phase = 0, y1[2] = {}, y2[2] = {};
  const double formants[] = {650, 1200}, widths[] = {90, 120};
  std::uint32_t random = 7;
  for (std::size_t i = 0; i < count; ++i) {
    const double pitch = from + (to - from) * double(i) / double(count);
    phase += pitch / rate;
    double x = 0;
    if (phase >= 1) {
      phase -= 1;
      x = 1;
    }
    double y = 0;
    for (int f = 0; f < 2; ++f) {
      const double r = std::exp(-std::numbers::pi * widths[f] / rate);
      const double turn = 2 * std::numbers::pi * formants[f] / rate;
      const double out = x + 2 * r * std::cos(turn) * y1[f] - r * r * y2[f];
      y2[f] = y1[f];
      y1[f] = out;
      y += out;
    }
    random = random * 1664525u + 1013904223u;
    y += noise * (double(random >> 16) / 32768 - 1);
    sound.samples.push_back(float(0.02 * y));
  }
  return sound;
}

/// Share of the frames from `begin` on whose pitch is within 3 % of what it should be.
double right(const media::Pcm& sound, double from, double to) {
  const dam::Prosody prosody = measure_prosody(sound);
  const double seconds = sound.duration();
  double good = 0, all = 0;
  for (std::size_t i = 5; i + 5 < prosody.pitch.size(); ++i) {
    const double wanted = from + (to - from) * double(i) * prosody.step / seconds;
    all += 1;
    good += std::abs(double(prosody.pitch[i]) / wanted - 1) < 0.03 ? 1 : 0;
  }
  return good / all;
}

TEST(Pitch, FollowsSyntheticVoices) {
  for (const int rate : {8000, 16000, 22050, 44100, 48000}) {
    for (const auto& [from, to] : {std::pair{80.0, 130.0}, {140.0, 100.0}, {180.0, 320.0}})
      EXPECT_GT(right(voiced(from, to, 2, rate), from, to), 0.97) << rate << " Hz, " << from;
  }
  EXPECT_GT(right(voiced(110, 160, 2, 22050, 2), 110, 160), 0.9) << "with noise";
}

TEST(Pitch, HasNoneWithoutAVoice) {
  media::Pcm noise;
  noise.sample_rate = 16000;
  std::uint32_t random = 3;
  for (int i = 0; i < 32000; ++i) {
    random = random * 1664525u + 1013904223u;
    noise.samples.push_back(0.1f * (float(random >> 16) / 32768 - 1));
  }
  const dam::Prosody hissing = measure_prosody(noise);
  const auto voiced_frames =
      std::count_if(hissing.pitch.begin(), hissing.pitch.end(), [](float p) { return p > 0; });
  EXPECT_LT(double(voiced_frames), 0.03 * double(hissing.pitch.size()));

  media::Pcm quiet = voiced(120, 120, 1, 16000);
  const std::size_t spoken = quiet.samples.size();
  quiet.samples.resize(2 * spoken);
  const dam::Prosody half = measure_prosody(quiet);
  ASSERT_EQ(half.pitch.size(), 200u);
  for (std::size_t i = 105; i < 200; ++i) EXPECT_EQ(half.pitch[i], 0) << i;
  EXPECT_GT(half.level[50], 10 * half.level[150]);
}

TEST(Pitch, TakesAnySound) {
  EXPECT_TRUE(measure_prosody({}).pitch.empty());
  EXPECT_TRUE(measure_prosody({2000, std::vector<float>(4000, 0.1f)}).pitch.empty());
  const dam::Prosody still = measure_prosody({16000, std::vector<float>(1600, 0.0f)});
  ASSERT_EQ(still.pitch.size(), 10u);
  EXPECT_EQ(still.pitch, std::vector<float>(10, 0.0f));
  EXPECT_EQ(measure_prosody({16000, {0.5f}}).level.size(), 1u);
}

}  // namespace pitch_test
}  // namespace animeme::voice
