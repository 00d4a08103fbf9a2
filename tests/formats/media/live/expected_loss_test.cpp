// The loss that an encoder of sound expects: by reports, in steps, within bounds, and back again.
#include "tools/formats/media/live/expected_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace animeme::media {
namespace expected_loss_test {

TEST(ExpectedLoss, RisesAtOnceAndFallsWhenItIsGone) {
  ExpectedLoss expected;
  EXPECT_EQ(expected.percent(0, 0), 0);
  EXPECT_EQ(expected.percent(1.0 / 256, 1), 0) << "a single packet";
  EXPECT_EQ(expected.percent(0.03, 5), 5);
  EXPECT_EQ(expected.percent(0.12, 10), 15);
  EXPECT_EQ(expected.percent(0.04, 15), 15);
  EXPECT_EQ(expected.percent(0, 39.9), 15);
  EXPECT_EQ(expected.percent(0, 40.1), 5) << "what was asked for meanwhile";
  EXPECT_EQ(expected.percent(0, 70), 5);
  EXPECT_EQ(expected.percent(0, 70.2), 0);
  EXPECT_EQ(expected.percent(0.005, 80), 2);
}

TEST(ExpectedLoss, HasBounds) {
  for (const double loss : {0.25, 0.5, 1.0, 7.0, double(INFINITY)}) {
    EXPECT_EQ(ExpectedLoss().percent(loss, 0), ExpectedLoss::kMost) << loss;
  }
  for (const double loss : {-1.0, 0.0, double(NAN)}) {
    EXPECT_EQ(ExpectedLoss().percent(loss, 0), 0) << loss;
  }
}

// A report of 5 s counts 250 packets: what it says scatters, but the encoder is not changed all the
// time.
TEST(ExpectedLoss, IsSteadyWhereReportsScatter) {
  ExpectedLoss expected;
  std::minstd_rand random(5);
  std::binomial_distribution<int> lost(250, 0.03);
  int changes = 0, before = 0;
  for (int second = 0; second < 3600; ++second) {
    static double share = 0;
    if (second % 5 == 0) share = lost(random) / 250.0;
    const int percent = expected.percent(share, second);
    changes += percent != before ? 1 : 0;
    before = percent;
    if (second > 30) {
      EXPECT_GE(percent, 2);
      EXPECT_LE(percent, 10);
    }
  }
  EXPECT_LT(changes, 60);
}

class Told : public LiveInput {
 public:
  const LiveInfo& info() const override { return info_; }
  std::optional<double> next_due() override { return std::nullopt; }
  Result<std::vector<LiveUnit>> take(double) override { return std::vector<LiveUnit>(); }
  double audio_ahead() const override { return 0; }
  void expect_loss(int percent) override { told.push_back(percent); }
  std::vector<int> told;

 private:
  LiveInfo info_;
};

TEST(ExpectedLoss, TellsOfChangesAlone) {
  Told input;
  ExpectedLoss expected;
  for (int i = 0; i < 1000; ++i) {
    SendStats stats;
    stats.reported_loss = 0.2;  // of receivers that have other means
    if (i >= 100 && i < 200) stats.sound_loss = 0.1;
    expected.follow(stats, 0.1 * i, input);
  }
  EXPECT_EQ(input.told, (std::vector<int>{10, 0}));
}

TEST(ExpectedLoss, IsRead) {
  EXPECT_EQ(*parse_expected_loss("auto"), AudioSettings::kLossByReports);
  EXPECT_EQ(*parse_expected_loss("0"), 0);
  EXPECT_EQ(*parse_expected_loss("50"), 50);
  for (const char* wrong : {"", "51", "-1", "5%", "Auto", "1.5", " 1", "99999999999"}) {
    EXPECT_EQ(parse_expected_loss(wrong).error().code, Code::invalid_argument) << wrong;
  }
}

}  // namespace expected_loss_test
}  // namespace animeme::media
