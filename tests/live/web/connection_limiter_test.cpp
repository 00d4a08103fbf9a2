// Who may come, ask and stay, on a clock of the test's own.
#include "tools/live/web/detail/connection_limiter.h"

#include <gtest/gtest.h>

#include <array>

namespace animeme::test {
namespace connection_limiter_test {

using web::ConnectionLimiter;
using Time = ConnectionLimiter::Clock::time_point;

Time at(double seconds) {
  return Time() + std::chrono::duration_cast<ConnectionLimiter::Clock::duration>(
                      std::chrono::duration<double>(1000 + seconds));
}

class ConnectionLimiterTest : public ::testing::Test {
 protected:
  ConnectionLimiter::Key key(std::size_t number) const { return &keys_[number]; }

 private:
  std::array<char, 1000> keys_{};
};

using Keys = std::vector<ConnectionLimiter::Key>;

TEST_F(ConnectionLimiterTest, ARequestHasItsTime) {
  ConnectionLimiter limiter({});
  limiter.enter(key(0), "a", at(0));
  limiter.enter(key(1), "a", at(0));
  EXPECT_TRUE(limiter.ask(key(1), at(1)));
  EXPECT_EQ(limiter.overdue(at(4)), Keys());
  EXPECT_EQ(limiter.overdue(at(6)), Keys{key(0)});
  EXPECT_EQ(limiter.overdue(at(7)), Keys()) << "named once";
  limiter.progress(key(1), at(20));
  EXPECT_EQ(limiter.overdue(at(39)), Keys()) << "its answer is on the way";
  limiter.answered(key(1), at(39));
  EXPECT_EQ(limiter.overdue(at(43)), Keys());
  EXPECT_EQ(limiter.overdue(at(45)), Keys{key(1)});
}

TEST_F(ConnectionLimiterTest, AnAnswerThatNobodyTakesIsGivenUp) {
  ConnectionLimiter limiter({.patience = 10});
  limiter.enter(key(0), "a", at(0));
  EXPECT_TRUE(limiter.ask(key(0), at(0)));
  EXPECT_EQ(limiter.overdue(at(9)), Keys());
  EXPECT_EQ(limiter.overdue(at(11)), Keys{key(0)});
}

TEST_F(ConnectionLimiterTest, WhoAsksNothingMakesRoom) {
  ConnectionLimiter limiter({.per_address = 3});
  for (std::size_t i = 0; i < 3; ++i) limiter.enter(key(i), "a", at(0));
  EXPECT_TRUE(limiter.ask(key(0), at(0)));
  EXPECT_TRUE(limiter.watch(key(0), false));
  EXPECT_TRUE(limiter.may_enter("a"));
  limiter.enter(key(3), "a", at(0));
  EXPECT_EQ(limiter.overdue(at(0)), Keys{key(1)}) << "the first of those that wait";
  limiter.leave(key(1));
  for (const std::size_t i : {2, 3}) {
    EXPECT_TRUE(limiter.ask(key(i), at(0)));
    EXPECT_TRUE(limiter.watch(key(i), false));
  }
  EXPECT_FALSE(limiter.may_enter("a"));
  EXPECT_TRUE(limiter.may_enter("b"));
  limiter.leave(key(2));
  EXPECT_TRUE(limiter.may_enter("a"));
}

TEST_F(ConnectionLimiterTest, AllOfThemTogetherAreLimitedToo) {
  ConnectionLimiter limiter({});
  for (std::size_t i = 0; i < ConnectionLimiter::kMostPassing + 10; ++i) {
    EXPECT_TRUE(limiter.may_enter(std::to_string(i)));
    limiter.enter(key(i), std::to_string(i), at(0));
  }
  EXPECT_EQ(limiter.overdue(at(0)).size(), 10u);
}

TEST_F(ConnectionLimiterTest, RequestsComeInBursts) {
  ConnectionLimiter limiter({});
  limiter.enter(key(0), "a", at(0));
  limiter.enter(key(1), "b", at(0));
  int granted = 0;
  for (int i = 0; i < 500; ++i) granted += limiter.ask(key(0), at(0));
  EXPECT_EQ(granted, int(ConnectionLimiter::kBurst));
  EXPECT_TRUE(limiter.ask(key(1), at(0)));
  for (int i = 0; i < 500; ++i) granted += limiter.ask(key(0), at(1));
  EXPECT_EQ(granted, int(ConnectionLimiter::kBurst + ConnectionLimiter::kRate));
  (void)limiter.overdue(at(100));
  EXPECT_TRUE(limiter.ask(key(0), at(100)));
}

TEST_F(ConnectionLimiterTest, AViewerHasAFaceASoundOrBoth) {
  ConnectionLimiter limiter({.viewers = 2});
  for (std::size_t i = 0; i < 5; ++i) limiter.enter(key(i), i < 4 ? "a" : "b", at(0));
  EXPECT_TRUE(limiter.watch(key(0), false));
  EXPECT_TRUE(limiter.watch(key(1), true));
  EXPECT_EQ(limiter.viewers(), 1);
  EXPECT_TRUE(limiter.watch(key(2), true));
  EXPECT_EQ(limiter.viewers(), 2);
  EXPECT_FALSE(limiter.watch(key(4), true));
  EXPECT_TRUE(limiter.watch(key(3), false)) << "the face of the second one";
  limiter.leave(key(0));
  limiter.leave(key(1));
  EXPECT_EQ(limiter.viewers(), 1);
  EXPECT_TRUE(limiter.watch(key(4), true));
  EXPECT_FALSE(limiter.watch(nullptr, true)) << "unknown";
}

}  // namespace connection_limiter_test
}  // namespace animeme::test
