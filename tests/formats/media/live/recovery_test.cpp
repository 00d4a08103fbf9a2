#include "tools/formats/media/live/recovery.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"

namespace animeme::media {
namespace recovery_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kTick = 1000;  // 25 planes a second

LiveUnit plane(std::int64_t number, bool intra) {
  return {LiveTrack::face, {std::uint8_t(number)}, intra, number * kTick, kTick};
}

// Numbers of planes that are given out. I 1 P 1 means: intra plane 0, predicted plane 1 ...
std::vector<int> run(FaceRecovery& recovery, const std::string& story) {
  std::vector<int> out;
  int number = 0;
  for (const char step : story) {
    LiveEvent event = LiveIdle{};
    if (step == 'I' || step == 'P') event = plane(number++, step == 'I');
    if (step == '-') event = LiveGap{LiveTrack::face, 1};
    if (step == '-') ++number;
    if (step == 'a') event = LiveGap{LiveTrack::audio, 1};
    if (step == '?') event = LiveGap{LiveTrack::face, 0};
    if (step == 'c') event = LiveInfo{{1}, 25000, 0x61, std::nullopt};
    if (step == 'd') event = LiveInfo{{2}, 25000, 0x61, std::nullopt};
    if (step == 's') event = LiveInfo{{1}, 25000, 0x61, test::aac_format()};
    if (step == 'E') event = LiveEnd{};
    if (const auto unit = recovery.accept(std::move(event))) out.push_back(unit->bytes[0]);
  }
  return out;
}

TEST(FaceRecovery, GivesEverythingWhenNothingIsMissing) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIPPIPE"), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(recovery.stats().share(), 1);
  EXPECT_EQ(recovery.stats().freezes, 0);
}

TEST(FaceRecovery, WaitsForTheFirstIntraPlane) {
  FaceRecovery recovery;
  EXPECT_TRUE(recovery.waiting());
  EXPECT_THAT(run(recovery, "cPPIP"), ElementsAre(2, 3));
  EXPECT_EQ(recovery.stats().dropped, 2);
  EXPECT_EQ(recovery.stats().freezes, 0);
}

TEST(FaceRecovery, DropsFromAGapToTheNextIntraPlane) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIP-PPIP?PI"), ElementsAre(0, 1, 5, 6, 8));
  const RecoveryStats& stats = recovery.stats();
  EXPECT_EQ(stats.usable, 5);
  EXPECT_EQ(stats.dropped, 3);
  EXPECT_EQ(stats.lost, 2);
  EXPECT_DOUBLE_EQ(stats.share(), 0.5);
  EXPECT_EQ(stats.freezes, 2);
  EXPECT_DOUBLE_EQ(stats.frozen_seconds, 0.16);
  EXPECT_DOUBLE_EQ(stats.longest_seconds, 0.12);
}

TEST(FaceRecovery, ALostIntraPlaneCostsItsWholeInterval) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIP-PPIPE"), ElementsAre(0, 1, 5, 6));
  EXPECT_THAT(recovery.take_intervals(),
              ElementsAre(IntraInterval{0, 5, 2}, IntraInterval{5 * kTick, 2, 2}));
  EXPECT_THAT(recovery.take_intervals(), IsEmpty());
}

TEST(FaceRecovery, SoundPassesAndItsGapsDoNotMatter) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIaPP"), ElementsAre(0, 1, 2));
  EXPECT_TRUE(recovery.accept(LiveUnit{LiveTrack::audio, {1}, false, 0, 1024}));
}

TEST(FaceRecovery, ANewConfigurationWaitsForAnIntraPlane) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIPcPsPdPIP"), ElementsAre(0, 1, 2, 3, 5, 6));
}

TEST(FaceRecovery, AfterTheEndItBeginsAnew) {
  FaceRecovery recovery;
  EXPECT_THAT(run(recovery, "cIPEPIP"), ElementsAre(0, 1, 3, 4));
}

TEST(FaceRecovery, KeepsTheLastIntervals) {
  FaceRecovery recovery;
  for (int i = 0; i < 5000; ++i) recovery.accept(plane(i, true));
  const auto intervals = recovery.take_intervals();
  ASSERT_EQ(intervals.size(), 4096u);
  EXPECT_EQ(intervals.back().begin, 4998 * kTick);
}

}  // namespace recovery_test
}  // namespace animeme::media
