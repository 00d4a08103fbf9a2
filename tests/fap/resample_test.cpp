// How far a clip may be stretched by another frame rate.
#include "fap/resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace animeme::fap {
namespace resample_test {

using testing::HasSubstr;

TEST(Resample, OneMoreThanTheMostIsRefused) {
  EXPECT_TRUE(check_resampling({25, 1}, {50, 1}, kMostResampled / 2));
  const auto more = check_resampling({25, 1}, {50, 1}, kMostResampled / 2 + 1);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, Code::out_of_range);
  EXPECT_THAT(more.error().message, HasSubstr("at most 20000000 frames"));
  EXPECT_TRUE(check_resampling({50, 1}, {25, 1}, 2 * kMostResampled));
  EXPECT_FALSE(check_resampling({50, 1}, {25, 1}, 2 * kMostResampled + 2));
}

// A single frame is one step of a Resampler, which gives all of what it becomes at once.
TEST(Resample, OneFrameBecomesSoManyAtMost) {
  EXPECT_TRUE(check_resampling({1, 1}, {std::uint32_t(kMostOfOne), 1}, 1));
  const auto more = check_resampling({1, 1}, {std::uint32_t(kMostOfOne) + 1, 1}, 1);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error().message, HasSubstr("100000 of a single one"));
}

TEST(Resample, RatesHaveToBeRates) {
  EXPECT_EQ(check_resampling({0, 1}, {25, 1}, 1).error().code, Code::invalid_argument);
  EXPECT_EQ(check_resampling({25, 1}, {1, 0}, 1).error().code, Code::invalid_argument);
}

// The frames that come out are as many as frames() says, wherever the rates meet.
TEST(Resample, CountsAreThoseOfTheFrames) {
  for (const Rate from : {Rate{25, 1}, Rate{30000, 1001}, Rate{7, 3}}) {
    for (const Rate to : {Rate{25, 1}, Rate{60, 1}, Rate{1, 1}, Rate{50, 1}, Rate{24000, 1001}}) {
      for (const std::int64_t frames : {0, 1, 2, 3, 10, 99, 100}) {
        Sequence clip{from, std::vector<Frame>(std::size_t(frames)), {}};
        const Sequence out = resample(clip, to);
        EXPECT_EQ(std::int64_t(out.frames.size()), Resampler(from, to).frames(frames));
        const double seconds = from.seconds(double(frames));
        const auto nearest = std::llround(seconds * to.frames_per_second());
        EXPECT_LE(std::abs(double(out.frames.size()) - double(nearest)), 1);
        for (std::size_t i = 0; i < out.frames.size(); ++i) {
          EXPECT_EQ(out.frames[i].number, std::int64_t(i));
        }
      }
    }
  }
}

// Between two frames values lie on the line, and behind the last one they rest.
TEST(Resample, ValuesLieOnTheLine) {
  Sequence clip{{10, 1}, {}, "line"};
  for (int i = 0; i < 5; ++i) clip.frames.emplace_back().set(3, 100 * i);
  const Sequence out = resample(clip, {40, 1});
  ASSERT_EQ(out.frames.size(), 20U);
  EXPECT_EQ(out.name, "line");
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(out.frames[std::size_t(i)].value[3], std::min(25 * i, 400)) << i;
  }
}

}  // namespace resample_test
}  // namespace animeme::fap
