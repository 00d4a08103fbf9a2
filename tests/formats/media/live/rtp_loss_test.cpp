// What a bad network leaves of a face: every plane that is given out has to be right.
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"

namespace animeme::media {
namespace rtp_loss_test {

using test::BadNetwork;
using test::LiveTalk;
using test::random_talk;
using test::Trouble;

struct Outcome {
  std::vector<LiveUnit> units;
  RecoveryStats stats;
  std::vector<IntraInterval> intervals;
};

Outcome run(const LiveTalk& talk, const RtpOptions& options, const Trouble& trouble,
            std::uint64_t seed) {
  Outcome outcome;
  FaceRecovery recovery;
  outcome.units = test::only(
      test::recovered(test::transfer(talk, options, trouble, seed), recovery), LiveTrack::face);
  outcome.stats = recovery.stats();
  outcome.intervals = recovery.take_intervals();
  return outcome;
}

class Loss : public ::testing::TestWithParam<int> {};

TEST_P(Loss, EveryPlaneThatIsGivenOutIsRight) {
  const LiveTalk talk = random_talk(500, 25);
  for (const int repeat : {1, 2}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Trouble trouble{GetParam(), 5, 5};
      const Outcome outcome = run(talk, {.repeat = repeat}, trouble, seed);
      test::expect_right(talk, outcome.units);
      EXPECT_EQ(std::int64_t(outcome.units.size()), outcome.stats.usable);
      if (GetParam() == 0) {
        EXPECT_EQ(outcome.units.size(), talk.units.size());
      }
      EXPECT_GT(outcome.units.size(), talk.units.size() / 10);
      // What is told of the intervals adds up.
      std::int64_t usable = 0;
      for (const IntraInterval& interval : outcome.intervals) {
        EXPECT_LE(interval.usable, interval.planes);
        usable += interval.usable;
      }
      EXPECT_EQ(usable, outcome.stats.usable);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Percent, Loss, ::testing::Values(0, 1, 5, 10));

TEST(Loss, FromTheNextIntraPlaneOnAllIsThereUntilTheNextLoss) {
  // With one packet a plane and no repetition, exactly the planes between a loss and the next
  // intra plane are missing.
  const LiveTalk talk = random_talk(300, 20);
  RtpSender sender(talk.info, {.mtu = 60000, .repeat = 1}, "192.0.2.1", 5004, 1, ntp_now());
  RtpReceiver receiver(*read_sdp(write_sdp(sender.session())), {}, 1);
  BadNetwork network(1, {});
  FaceRecovery recovery;
  std::vector<LiveEvent> events;
  std::vector<LiveUnit> expected;
  bool good = false;
  for (std::size_t i = 0; i < talk.units.size(); ++i) {
    RtpSender::Datagrams out;
    ASSERT_TRUE(sender.send(talk.units[i], 0.04 * double(i), out));
    const bool lost = i % 47 == 13;
    good = !lost && (good || talk.units[i].intra);
    if (good) expected.push_back(talk.units[i]);
    if (!lost) network.put(out, 0.04 * double(i));
    test::deliver(network, receiver, 0.04 * double(i), events);
  }
  test::deliver(network, receiver, 100, events);
  EXPECT_EQ(test::recovered(events, recovery), expected);
  EXPECT_EQ(recovery.stats().lost, 7);
}

TEST(Loss, RepetitionHelps) {
  const LiveTalk talk = random_talk(1000, 25);
  const double once = run(talk, {.repeat = 1}, {.loss = 5}, 4).stats.share();
  const double twice = run(talk, {.repeat = 2}, {.loss = 5}, 4).stats.share();
  EXPECT_LT(once, 0.8);
  EXPECT_GT(twice, 0.9);
}

TEST(Loss, PiecesAndBundlesAreRightToo) {
  const LiveTalk talk = random_talk(300, 25);
  for (const RtpOptions& options : {RtpOptions{.mtu = 256, .repeat = 2}, RtpOptions{.bundle = 4}}) {
    const Outcome outcome = run(talk, options, {.loss = 3, .reorder = 10}, 8);
    test::expect_right(talk, outcome.units);
    EXPECT_GT(outcome.units.size(), 100u);
  }
}

}  // namespace rtp_loss_test
}  // namespace animeme::media
