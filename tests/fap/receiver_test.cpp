// Frames one by one: what a receiver shows, and clips at another rate.
#include "fap/receiver.h"

#include <gtest/gtest.h>

#include "fap/resample.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace receiver_test {

TEST(Receiver, ShowsWhatFillShows) {
  made::Random random(20261123);
  for (int round = 0; round < 100; ++round) {
    const Sequence clip = made::random_sequence(random, int(random.in(1, 30)));
    const FillOptions options{.mirror = random.in(0, 1) != 0,
                              .keep_high_level = random.in(0, 1) != 0,
                              .expand = random.in(0, 1) != 0,
                              .complete = random.in(0, 1) != 0};
    const auto filled = fill(clip, options);
    ASSERT_TRUE(filled);
    Receiver receiver(options);
    std::vector<Frame> shown;
    for (const Frame& frame : clip.frames) {
      while (std::int64_t(shown.size()) < frame.number) shown.push_back(receiver.hold());
      shown.push_back(receiver.receive(frame));
      EXPECT_EQ(shown.back().number, frame.number);
    }
    ASSERT_EQ(shown.size(), filled->frames.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      Frame last = with_mask(shown[i], receiver.mask());
      last.number = std::int64_t(i);
      ASSERT_EQ(last, filled->frames[i]) << round << " " << i;
    }
  }
}

Sequence ramp(Rate rate, int frames) {
  Sequence clip{rate, {}, "ramp"};
  for (int i = 0; i < frames; ++i) {
    Frame frame = made::make_frame(i, {{3, 1000 * i}});
    frame.mask.set(1);
    frame.viseme.select1 = i % 15;
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(Resample, LiesOnTheLineAndKeepsTheDuration) {
  const std::vector<Rate> rates = {{25, 1}, {30, 1}, {30000, 1001}, {24000, 1001},
                                   {25, 2}, {1, 1},  {60, 1},       {10, 1}};
  for (const Rate from : rates) {
    for (const Rate to : rates) {
      for (const int count : {1, 2, 6, 7, 11, 100}) {
        const Sequence clip = ramp(from, count);
        const Sequence other = resample(clip, to);
        const Resampler resampler(from, to);
        ASSERT_EQ(resampler.frames(count), std::int64_t(other.frames.size()));
        EXPECT_EQ(other.rate, to);
        EXPECT_EQ(other.name, "ramp");
        EXPECT_NEAR(other.duration(), clip.duration(),
                    std::max(from.seconds(1), to.seconds(1)) + 1e-9);
        for (std::size_t i = 0; i < other.frames.size(); ++i) {
          ASSERT_EQ(other.frames[i].number, std::int64_t(i));
          const double at = to.seconds(double(i)) * from.frames_per_second();
          ASSERT_NEAR(other.frames[i].value[3], 1000 * std::min(at, count - 1.0), 0.51);
        }
      }
    }
  }
}

TEST(Resample, TheSameRateIsTheSameClip) {
  const Sequence clip = ramp({30000, 1001}, 300);
  EXPECT_EQ(resample(clip, clip.rate), clip);
}

TEST(Resample, NothingStaysNothing) {
  EXPECT_TRUE(resample(Sequence{{25, 1}, {}, "x"}, {30, 1}).frames.empty());
}

}  // namespace receiver_test
}  // namespace animeme::fap
