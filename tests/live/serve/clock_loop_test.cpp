#include "tools/live/serve/clock_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

namespace animeme::test {
namespace clock_loop_test {

using serve::Beat;
using serve::ClockLoop;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Counts its steps; every `period` seconds, or when it is woken.
class Counter : public Beat {
 public:
  explicit Counter(double period, double work = 0) : period_(period), work_(work) {}
  double step() override {
    EXPECT_EQ(inside_.fetch_add(1), 0) << "two steps at a time";
    if (work_ > 0) std::this_thread::sleep_for(std::chrono::duration<double>(work_));
    ++steps;
    inside_.fetch_sub(1);
    next_ = next_ < 0 ? media::steady_clock().now() : next_;
    return period_ == kNever ? kNever : next_ += period_;
  }
  std::atomic<int> steps = 0;

 private:
  const double period_, work_;
  double next_ = -1;
  std::atomic<int> inside_ = 0;
};

template <class Condition>
bool until(const Condition& condition) {
  for (int i = 0; i < 3000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return condition();
}

TEST(ClockLoop, StepsComeInTime) {
  ClockLoop loop(media::steady_clock(), {.threads = 2});
  std::vector<std::shared_ptr<Counter>> counters;
  const double begin = media::steady_clock().now();
  for (int i = 0; i < 50; ++i) {
    counters.push_back(std::make_shared<Counter>(0.02));
    loop.add(counters.back());
  }
  for (const auto& counter : counters) EXPECT_TRUE(until([&] { return counter->steps >= 20; }));
  const double took = media::steady_clock().now() - begin;
  EXPECT_GE(took, 19 * 0.02);
  for (const auto& counter : counters) {
    loop.remove(counter.get());
    EXPECT_LE(counter->steps, took / 0.02 + 2);  // none comes before it is due
  }
}

TEST(ClockLoop, WhatSleepsIsWoken) {
  ClockLoop loop(media::steady_clock(), {.threads = 2});
  const auto sleeper = std::make_shared<Counter>(kNever);
  loop.add(sleeper);
  for (int i = 1; i < 20; ++i) {
    EXPECT_TRUE(until([&] { return sleeper->steps >= i; }));
    loop.wake(sleeper.get());
  }
  EXPECT_TRUE(until([&] { return sleeper->steps >= 20; }));
  loop.wake(nullptr);  // nobody
}

TEST(ClockLoop, AWakeUpDuringAStepIsNotLost) {
  ClockLoop loop(media::steady_clock(), {.threads = 1});
  const auto sleeper = std::make_shared<Counter>(kNever, 0.1);
  loop.add(sleeper);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  loop.wake(sleeper.get());
  EXPECT_TRUE(until([&] { return sleeper->steps >= 2; }));
}

TEST(ClockLoop, NothingStepsAfterRemove) {
  ClockLoop loop(media::steady_clock(), {.threads = 2, .grain = 0});
  for (int i = 0; i < 50; ++i) {
    const auto counter = std::make_shared<Counter>(0.0005, 0.001);
    loop.add(counter);
    EXPECT_TRUE(until([&] { return counter->steps >= 1; }));
    loop.remove(counter.get());
    const int steps = counter->steps;
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    EXPECT_EQ(counter->steps, steps);
    EXPECT_EQ(counter.use_count(), 1);
  }
}

TEST(ClockLoop, EndsWhileThereIsWork) {
  const auto counter = std::make_shared<Counter>(0.001);
  {
    ClockLoop loop(media::steady_clock(), {.threads = 4});
    loop.add(counter);
    EXPECT_TRUE(until([&] { return counter->steps >= 3; }));
  }
  EXPECT_EQ(counter.use_count(), 1);
}

}  // namespace clock_loop_test
}  // namespace animeme::test
