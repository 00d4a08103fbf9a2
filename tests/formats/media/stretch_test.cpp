// Sound that is stretched keeps its pitch, its length is exact, and everything stays at its place.
#include "tools/formats/media/stretch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace animeme::media {
namespace stretch_test {

constexpr int kRate = 16000;
constexpr double kSpeeds[] = {0.05, 0.5, 0.8, 0.95, 1.1, 1.5, 2, 3.7, 20};

std::vector<float> tone(double hertz, double seconds, int rate = kRate) {
  std::vector<float> samples;
  for (int i = 0; i < int(seconds * rate); ++i) {
    samples.push_back(float(0.5 * std::sin(2 * std::numbers::pi * hertz * i / rate)));
  }
  return samples;
}

// Pushed in pieces of many sizes.
std::vector<float> stretched(const std::vector<float>& samples, int channels, double speed) {
  TimeStretch stretch(kRate, channels, speed);
  std::vector<float> out;
  const std::size_t frames = samples.size() / std::size_t(channels);
  std::size_t at = 0;
  for (std::size_t size = 1; at < frames; size = size * 3 % 4001 + 1) {
    const std::size_t count = std::min(size, frames - at);
    const auto first = at * std::size_t(channels);
    stretch.push(std::span(samples).subspan(first, count * std::size_t(channels)), out);
    at += count;
  }
  stretch.finish(out);
  return out;
}

double hertz_of(const std::vector<float>& samples) {
  const std::size_t begin = samples.size() / 10, end = samples.size() - begin;
  int rising = 0;
  for (std::size_t i = begin + 1; i < end; ++i) rising += samples[i - 1] < 0 && samples[i] >= 0;
  return double(rising) * kRate / double(end - begin);
}

double level_of(const std::vector<float>& samples) {
  const std::size_t begin = samples.size() / 10, end = samples.size() - begin;
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += double(samples[i]) * samples[i];
  return std::sqrt(sum / double(end - begin));
}

TEST(Stretch, TheLengthIsExact) {
  for (const double speed : kSpeeds) {
    for (const std::size_t size :
         {std::size_t(0), std::size_t(1), std::size_t(777), std::size_t(16001)}) {
      const std::vector<float> samples(size, 0.25f);
      EXPECT_EQ(stretched(samples, 1, speed).size(),
                std::size_t(std::llround(double(size) / speed)))
          << speed << " " << size;
    }
  }
}

TEST(Stretch, ThePitchAndTheLevelStay) {
  for (const double speed : {0.5, 0.8, 0.95, 1.1, 1.5, 2.0}) {
    for (const double hertz : {90.0, 220.0, 1000.0}) {
      const auto out = stretched(tone(hertz, 2), 1, speed);
      EXPECT_NEAR(hertz_of(out), hertz, 0.03 * hertz + 3) << speed;
      EXPECT_NEAR(level_of(out), level_of(tone(hertz, 2)), 0.06) << speed << " at " << hertz;
    }
  }
}

TEST(Stretch, BurstsAreWhereTheyBelong) {
  for (const double speed : {0.5, 0.8, 1.25, 2.0}) {
    std::vector<float> samples(5 * kRate, 0.0f);
    const auto burst = tone(400, 0.1);
    for (int second = 1; second < 5; ++second) {
      std::copy(burst.begin(), burst.end(), samples.begin() + second * kRate);
    }
    const auto out = stretched(samples, 1, speed);
    for (int second = 1; second < 5; ++second) {
      // The first loud sample from half a second before.
      std::size_t at = std::size_t((second - 0.5) * kRate / speed);
      while (at < out.size() && std::abs(out[at]) < 0.1f) ++at;
      EXPECT_NEAR(double(at) / kRate, second / speed, 0.01 + 0.015 * std::abs(1 - 1 / speed))
          << speed;
    }
  }
}

TEST(Stretch, ChannelsStayTogether) {
  std::vector<float> samples;
  for (const float sample : tone(300, 3)) samples.insert(samples.end(), {sample, -0.5f * sample});
  const auto out = stretched(samples, 2, 0.8);
  ASSERT_EQ(out.size(), std::size_t(std::llround(double(samples.size() / 2) / 0.8)) * 2);
  for (std::size_t i = 0; i + 1 < out.size(); i += 2) {
    ASSERT_NEAR(out[i + 1], -0.5f * out[i], 1e-5) << i;
  }
}

TEST(Stretch, PiecesOfTheInputDoNotMatter) {
  const auto samples = tone(333, 2);
  TimeStretch whole(kRate, 1, 0.7);
  std::vector<float> at_once;
  whole.push(samples, at_once);
  whole.finish(at_once);
  EXPECT_EQ(at_once, stretched(samples, 1, 0.7));
}

}  // namespace stretch_test
}  // namespace animeme::media
