// A source that is not there yet, and one whose connection breaks: without sockets and clocks.
#include "tools/live/sessions/patient_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace animeme::live {
namespace patient_source_test {

using media::LiveEvent;
using media::LiveIdle;
using media::LiveRestart;
using media::LiveUnit;

/// Gives so many units, then an error.
class Breaking : public media::LiveSource {
 public:
  Breaking(int units, Error error) : left_(units), error_(std::move(error)) {}
  Result<LiveEvent> next(double) override {
    if (left_-- <= 0) return error_;
    ++stats_.packets;
    return LiveEvent(LiveUnit{.bytes = {1}, .time = left_});
  }
  media::ReceiveStats stats() const override { return stats_; }

 private:
  int left_;
  Error error_;
  media::ReceiveStats stats_;
};

bool is_passing(const Error& error) { return error.code == Code::io; }

TEST(PatientSource, WaitsAndComesBackAfterEverLongerPauses) {
  media::JumpingClock clock;
  std::vector<double> tries;
  int opened = 0;
  PatientSource source(
      [&]() -> Result<std::unique_ptr<media::LiveSource>> {
        tries.push_back(clock.now());
        if (clock.now() < 5) return make_error(Code::io, "nobody is there");
        ++opened;
        return std::unique_ptr<media::LiveSource>(
            std::make_unique<Breaking>(3, make_error(Code::io, "the connection broke")));
      },
      is_passing, clock);
  int units = 0, restarts = 0;
  while (clock.now() < 20) {
    const double before = clock.now();
    const auto event = source.next(0.1);
    ASSERT_TRUE(event);
    EXPECT_LE(clock.now(), before + 0.1 + 1e-9) << "longer than it was told";
    units += std::holds_alternative<LiveUnit>(*event);
    restarts += std::holds_alternative<LiveRestart>(*event);
    if (opened == 0) {
      ASSERT_TRUE(source.waiting_for());
      EXPECT_EQ(source.waiting_for()->message, "nobody is there");
    }
  }
  EXPECT_EQ(units, 3 * opened);
  EXPECT_EQ(restarts, opened - 1) << "nothing came before the first one";
  EXPECT_GT(opened, 10);
  EXPECT_EQ(source.stats().packets, units);
  ASSERT_GT(tries.size(), 5u);
  EXPECT_EQ(tries[0], 0);
  EXPECT_NEAR(tries[1], 0.1, 1e-9);
  for (std::size_t i = 1; i < tries.size(); ++i) {
    EXPECT_GE(tries[i] - tries[i - 1], 0.1 - 1e-9);
    EXPECT_LE(tries[i] - tries[i - 1], 1.1);
  }
}

TEST(PatientSource, WhatWillNotPassIsAnErrorAtOnce) {
  media::JumpingClock clock;
  PatientSource refused(
      []() -> Result<std::unique_ptr<media::LiveSource>> {
        return make_error(Code::syntax, "no description");
      },
      is_passing, clock);
  EXPECT_EQ(refused.try_now().error().code, Code::syntax);
  EXPECT_EQ(refused.next(1).error().code, Code::syntax);
  EXPECT_EQ(clock.now(), 0);
  PatientSource damaged(
      []() -> Result<std::unique_ptr<media::LiveSource>> {
        return std::unique_ptr<media::LiveSource>(
            std::make_unique<Breaking>(1, make_error(Code::syntax, "noise")));
      },
      is_passing, clock);
  EXPECT_TRUE(damaged.next(1));
  EXPECT_EQ(damaged.next(1).error().code, Code::syntax);
}

}  // namespace patient_source_test
}  // namespace animeme::live
