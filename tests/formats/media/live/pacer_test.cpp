#include "tools/formats/media/live/pacer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace animeme::media {
namespace pacer_test {

// Sleeps too long by a fixed time, as real machines do.
class TardyClock : public Clock {
 public:
  explicit TardyClock(double tardy) : tardy_(tardy) {}
  double now() override { return now_; }
  void sleep_until(double instant) override {
    ++sleeps;
    longest = std::max(longest, instant - now_);
    now_ = std::max(now_, instant) + tardy_;
  }
  void pass(double seconds) { now_ += seconds; }

  int sleeps = 0;
  double longest = 0;

 private:
  double now_ = 1000;
  double tardy_;
};

TEST(Pacer, HoldsAbsoluteInstantsSoThatTardySleepDoesNotAddUp) {
  TardyClock clock(0.003);
  Pacer pacer(clock);
  for (int frame = 0; frame < 100000; ++frame) {
    const double due = frame * 0.04;
    while (!pacer.wait_until(due)) {
    }
    pacer.sent(due);
    ASSERT_GE(pacer.now(), due - 1e-9);
    ASSERT_LE(pacer.now(), due + 0.0031);
  }
  EXPECT_NEAR(pacer.lateness().mean(), 0.003, 1e-4);
  EXPECT_NEAR(pacer.lateness().worst(), 0.003, 1e-4);
}

TEST(Pacer, SleepsInSlicesSoThatSinksCanBePolled) {
  TardyClock clock(0);
  Pacer pacer(clock, 0.05);
  int polls = 0;
  while (!pacer.wait_until(1.0)) ++polls;
  EXPECT_GE(polls, 18);
  EXPECT_LE(clock.longest, 0.05 + 1e-9);
}

TEST(Pacer, WhatIsLateIsDueAtOnceAndCatchesUp) {
  TardyClock clock(0);
  Pacer pacer(clock);
  clock.pass(0.5);
  const int before = clock.sleeps;
  for (double due = 0; due < 0.5; due += 0.04) EXPECT_TRUE(pacer.wait_until(due));
  EXPECT_EQ(clock.sleeps, before);
  EXPECT_FALSE(pacer.wait_until(0.6));
}

TEST(Pacer, RestartMovesTimeZero) {
  TardyClock clock(0);
  Pacer pacer(clock);
  clock.pass(2);
  pacer.restart(0.25);
  EXPECT_NEAR(pacer.now(), -0.25, 1e-9);
  EXPECT_TRUE(pacer.wait_until(-0.3));
  EXPECT_FALSE(pacer.wait_until(0.1));
}

TEST(Pacer, TheSteadyClockSleepsUntilTheInstantAndNeverLess) {
  Clock& clock = steady_clock();
  const double begin = clock.now();
  clock.sleep_until(begin + 0.02);
  EXPECT_GE(clock.now(), begin + 0.02);
}

TEST(JumpingClock, IsWhereOneSleepsTo) {
  JumpingClock clock;
  clock.sleep_until(3);
  clock.sleep_until(2);
  EXPECT_EQ(clock.now(), 3);
}

TEST(LatenessMeter, PercentilesOfAUniformSpread) {
  LatenessMeter meter;
  EXPECT_EQ(meter.percentile(0.99), 0);
  for (int i = 0; i < 10000; ++i) meter.add(i * 1e-5);  // 0 .. 0.1 s
  EXPECT_EQ(meter.count(), 10000);
  EXPECT_NEAR(meter.mean(), 0.05, 1e-4);
  EXPECT_NEAR(meter.percentile(0.5), 0.05, 2e-4);
  EXPECT_NEAR(meter.percentile(0.99), 0.099, 2e-4);
  EXPECT_NEAR(meter.percentile(1), 0.09999, 1e-9);
  EXPECT_NEAR(meter.worst(), 0.09999, 1e-9);
}

TEST(LatenessMeter, LongDelaysAreKnownToFivePercentAndNegativeOnesAreNone) {
  LatenessMeter meter;
  for (const double seconds : {-1.0, 0.0, 0.5, 2.0, 60.0, 1e6}) meter.add(seconds);
  EXPECT_NEAR(meter.percentile(3.0 / 6), 0.5, 0.025);
  EXPECT_NEAR(meter.percentile(4.0 / 6), 2.0, 0.1);
  EXPECT_NEAR(meter.percentile(5.0 / 6), 60.0, 3.0);
  EXPECT_EQ(meter.worst(), 1e6);
  EXPECT_EQ(meter.percentile(1.0 / 6), 1e-4);
}

}  // namespace pacer_test
}  // namespace animeme::media
