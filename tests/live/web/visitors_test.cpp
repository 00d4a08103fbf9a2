// Who may come, ask and stay, on a clock of the test's own.
#include "tools/live/web/detail/visitors.h"

#include <gtest/gtest.h>

#include <array>

namespace animeme::test {
namespace visitors_test {

using web::Visitors;
using Time = Visitors::Clock::time_point;

Time at(double seconds) {
  return Time() + std::chrono::duration_cast<Visitors::Clock::duration>(
                      std::chrono::duration<double>(1000 + seconds));
}

class VisitorsTest : public ::testing::Test {
 protected:
  Visitors::Key key(std::size_t number) const { return &keys_[number]; }

 private:
  std::array<char, 1000> keys_{};
};

using Keys = std::vector<Visitors::Key>;

TEST_F(VisitorsTest, ARequestHasItsTime) {
  Visitors visitors({});
  visitors.enter(key(0), "a", at(0));
  visitors.enter(key(1), "a", at(0));
  EXPECT_TRUE(visitors.ask(key(1), at(1)));
  EXPECT_EQ(visitors.overdue(at(4)), Keys());
  EXPECT_EQ(visitors.overdue(at(6)), Keys{key(0)});
  EXPECT_EQ(visitors.overdue(at(7)), Keys()) << "named once";
  visitors.progress(key(1), at(20));
  EXPECT_EQ(visitors.overdue(at(39)), Keys()) << "its answer is on the way";
  visitors.answered(key(1), at(39));
  EXPECT_EQ(visitors.overdue(at(43)), Keys());
  EXPECT_EQ(visitors.overdue(at(45)), Keys{key(1)});
}

TEST_F(VisitorsTest, AnAnswerThatNobodyTakesIsGivenUp) {
  Visitors visitors({.patience = 10});
  visitors.enter(key(0), "a", at(0));
  EXPECT_TRUE(visitors.ask(key(0), at(0)));
  EXPECT_EQ(visitors.overdue(at(9)), Keys());
  EXPECT_EQ(visitors.overdue(at(11)), Keys{key(0)});
}

TEST_F(VisitorsTest, WhoAsksNothingMakesRoom) {
  Visitors visitors({.per_address = 3});
  for (std::size_t i = 0; i < 3; ++i) visitors.enter(key(i), "a", at(0));
  EXPECT_TRUE(visitors.ask(key(0), at(0)));
  EXPECT_TRUE(visitors.watch(key(0), false));
  EXPECT_TRUE(visitors.may_enter("a"));
  visitors.enter(key(3), "a", at(0));
  EXPECT_EQ(visitors.overdue(at(0)), Keys{key(1)}) << "the first of those that wait";
  visitors.leave(key(1));
  for (const std::size_t i : {2, 3}) {
    EXPECT_TRUE(visitors.ask(key(i), at(0)));
    EXPECT_TRUE(visitors.watch(key(i), false));
  }
  EXPECT_FALSE(visitors.may_enter("a"));
  EXPECT_TRUE(visitors.may_enter("b"));
  visitors.leave(key(2));
  EXPECT_TRUE(visitors.may_enter("a"));
}

TEST_F(VisitorsTest, AllOfThemTogetherAreLimitedToo) {
  Visitors visitors({});
  for (std::size_t i = 0; i < Visitors::kMostPassing + 10; ++i) {
    EXPECT_TRUE(visitors.may_enter(std::to_string(i)));
    visitors.enter(key(i), std::to_string(i), at(0));
  }
  EXPECT_EQ(visitors.overdue(at(0)).size(), 10u);
}

TEST_F(VisitorsTest, RequestsComeInBursts) {
  Visitors visitors({});
  visitors.enter(key(0), "a", at(0));
  visitors.enter(key(1), "b", at(0));
  int granted = 0;
  for (int i = 0; i < 500; ++i) granted += visitors.ask(key(0), at(0));
  EXPECT_EQ(granted, int(Visitors::kBurst));
  EXPECT_TRUE(visitors.ask(key(1), at(0)));
  for (int i = 0; i < 500; ++i) granted += visitors.ask(key(0), at(1));
  EXPECT_EQ(granted, int(Visitors::kBurst + Visitors::kRate));
  (void)visitors.overdue(at(100));
  EXPECT_TRUE(visitors.ask(key(0), at(100)));
}

TEST_F(VisitorsTest, AViewerHasAFaceASoundOrBoth) {
  Visitors visitors({.viewers = 2});
  for (std::size_t i = 0; i < 5; ++i) visitors.enter(key(i), i < 4 ? "a" : "b", at(0));
  EXPECT_TRUE(visitors.watch(key(0), false));
  EXPECT_TRUE(visitors.watch(key(1), true));
  EXPECT_EQ(visitors.viewers(), 1);
  EXPECT_TRUE(visitors.watch(key(2), true));
  EXPECT_EQ(visitors.viewers(), 2);
  EXPECT_FALSE(visitors.watch(key(4), true));
  EXPECT_TRUE(visitors.watch(key(3), false)) << "the face of the second one";
  visitors.leave(key(0));
  visitors.leave(key(1));
  EXPECT_EQ(visitors.viewers(), 1);
  EXPECT_TRUE(visitors.watch(key(4), true));
  EXPECT_FALSE(visitors.watch(nullptr, true)) << "unknown";
}

}  // namespace visitors_test
}  // namespace animeme::test
