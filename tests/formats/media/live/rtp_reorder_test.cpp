#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/formats/media/live/rtp_support.h"
#include "tools/formats/media/rtp/jitter.h"

namespace animeme::media {
namespace rtp_reorder_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A buffer that has begun with packet `first` and given it out.
ReorderBuffer begun(int first, ReorderLimits limits = {}) {
  ReorderBuffer buffer(limits);
  RtpPacket packet;
  packet.sequence = std::uint16_t(first);
  buffer.add(packet, -100);
  buffer.next(-1);
  return buffer;
}

// Numbers of packets that come out; gaps as their negative size, 1000 for one of unknown size.
std::vector<int> take(ReorderBuffer& buffer, double now) {
  std::vector<int> out;
  while (const auto item = buffer.next(now)) {
    if (const auto* packet = std::get_if<RtpPacket>(&*item)) {
      out.push_back(packet->sequence);
    } else {
      const auto packets = std::get<ReorderBuffer::Missing>(*item).packets;
      out.push_back(packets == 0 ? 1000 : int(-packets));
    }
  }
  return out;
}

bool add(ReorderBuffer& buffer, int sequence, double now) {
  RtpPacket packet;
  packet.sequence = std::uint16_t(sequence);
  return buffer.add(packet, now);
}

TEST(ReorderBuffer, GivesPacketsInOrderAtOnce) {
  ReorderBuffer buffer = begun(9);
  add(buffer, 10, 0);
  add(buffer, 11, 0);
  EXPECT_THAT(take(buffer, 0), ElementsAre(10, 11));
  add(buffer, 13, 0);
  EXPECT_THAT(take(buffer, 0), IsEmpty());
  add(buffer, 12, 0.05);
  EXPECT_THAT(take(buffer, 0.05), ElementsAre(12, 13));
  EXPECT_EQ(buffer.counts().reordered, 1);
  EXPECT_EQ(buffer.counts().lost, 0);
}

TEST(ReorderBuffer, TheBeginWaitsForWhatIsEarlier) {
  ReorderBuffer buffer({.seconds = 0.1});
  add(buffer, 5, 1);
  add(buffer, 6, 1.04);
  EXPECT_THAT(take(buffer, 1.05), IsEmpty());
  EXPECT_NEAR(buffer.deadline().value_or(0), 1.1, 1e-9);
  EXPECT_TRUE(add(buffer, 3, 1.06));
  EXPECT_TRUE(add(buffer, 4, 1.08));
  EXPECT_THAT(take(buffer, 1.09), IsEmpty());
  EXPECT_THAT(take(buffer, 1.11), ElementsAre(3, 4, 5, 6));
  EXPECT_FALSE(add(buffer, 2, 1.13));
  EXPECT_EQ(buffer.expected(), 4);

  ReorderBuffer impatient({.seconds = 0});
  add(impatient, 5, 1);
  EXPECT_THAT(take(impatient, 1), ElementsAre(5));
}

TEST(ReorderBuffer, WaitsForItsTimeAndThenReportsTheGap) {
  ReorderBuffer buffer = begun(0, {.seconds = 0.1});
  add(buffer, 1, 0);
  add(buffer, 4, 0.2);
  add(buffer, 5, 0.25);
  EXPECT_THAT(take(buffer, 0.29), ElementsAre(1));
  EXPECT_NEAR(buffer.deadline().value_or(0), 0.3, 1e-9);
  EXPECT_THAT(take(buffer, 0.301), ElementsAre(-2, 4, 5));
  EXPECT_FALSE(buffer.deadline());
  EXPECT_FALSE(add(buffer, 2, 0.4));
  EXPECT_THAT(take(buffer, 1), IsEmpty());
  EXPECT_EQ(buffer.counts().lost, 2);
  EXPECT_EQ(buffer.counts().late, 1);
  EXPECT_EQ(buffer.expected(), 6);
}

TEST(ReorderBuffer, HoldsAtMostSoManyPackets) {
  ReorderBuffer buffer = begun(65535, {.seconds = 10, .packets = 3});
  add(buffer, 0, 0);
  for (int i = 2; i < 5; ++i) add(buffer, i, 0);
  EXPECT_THAT(take(buffer, 0), ElementsAre(0));
  add(buffer, 5, 0);
  EXPECT_THAT(take(buffer, 0), ElementsAre(-1, 2, 3, 4, 5));
}

TEST(ReorderBuffer, DropsDuplicatesWhereverTheyAre) {
  ReorderBuffer buffer = begun(0);
  EXPECT_TRUE(add(buffer, 1, 0));
  EXPECT_FALSE(add(buffer, 1, 0));
  take(buffer, 0);
  EXPECT_FALSE(add(buffer, 1, 0));
  EXPECT_TRUE(add(buffer, 3, 0));
  EXPECT_FALSE(add(buffer, 3, 0));
  EXPECT_THAT(take(buffer, 0), IsEmpty());
  EXPECT_EQ(buffer.counts().duplicates, 3);
  EXPECT_EQ(buffer.counts().received, 3);
}

TEST(ReorderBuffer, NumbersWrap) {
  ReorderBuffer buffer = begun(64999);
  std::vector<int> got;
  for (int i = 65000; i < 200000; ++i) {
    // Each pair is swapped.
    add(buffer, (i ^ 1) & 0xFFFF, 0);
    for (const int each : take(buffer, 0)) got.push_back(each);
  }
  ASSERT_GT(got.size(), 130000u);
  for (std::size_t i = 1; i < got.size(); ++i) {
    ASSERT_EQ(std::uint16_t(got[i] - got[i - 1]), 1) << i;
  }
  EXPECT_EQ(buffer.counts().lost, 0);
  EXPECT_GE(buffer.highest() >> 16, 2u);
}

TEST(ReorderBuffer, AJumpHasToBeConfirmed) {
  ReorderBuffer buffer = begun(65535);
  for (int i = 0; i < 5; ++i) add(buffer, i, 0);
  add(buffer, 30000, 0);  // a stray packet
  add(buffer, 5, 0);
  EXPECT_THAT(take(buffer, 0), ElementsAre(0, 1, 2, 3, 4, 5));
  add(buffer, 40000, 0);
  add(buffer, 40001, 0);  // a sender that has begun anew
  EXPECT_THAT(take(buffer, 0), ElementsAre(1000, 40000, 40001));
  EXPECT_EQ(buffer.counts().received, 9);
  EXPECT_EQ(buffer.expected(), 9);
}

TEST(ReorderBuffer, FlushGivesUpWhatIsMissing) {
  ReorderBuffer buffer({});
  add(buffer, 0, 0);
  add(buffer, 2, 0);
  buffer.flush();
  EXPECT_THAT(take(buffer, 0), ElementsAre(0, -1, 2));
}

// Every third packet comes 0.3 s late, as on a net with several ways: most of it is lost at first,
// and nothing from the moment on when the buffer has seen how late they are.
TEST(ReorderBuffer, WaitsLongerWherePacketsComeLate) {
  ReorderBuffer buffer({.seconds = 0.1});
  std::multimap<double, int> arrivals;
  for (int i = 0; i < 500; ++i) arrivals.emplace(i * 0.04 + (i % 3 == 0 ? 0.3 : 0), i);
  std::int64_t lost_early = 0;
  for (const auto& [now, number] : arrivals) {
    add(buffer, number, now);
    take(buffer, now);
    if (now < 1) lost_early = buffer.counts().lost;
  }
  EXPECT_GT(lost_early, 0);
  EXPECT_EQ(buffer.counts().lost, lost_early);
  EXPECT_NEAR(buffer.wait(), 0.3, 0.1);
  EXPECT_NEAR(buffer.latest(), 0.28, 0.05);
  for (int i = 500; i < 1500; ++i) {  // it becomes quiet: slowly, patience goes
    add(buffer, i, i * 0.04);
    take(buffer, i * 0.04);
  }
  EXPECT_EQ(buffer.wait(), 0.1);
}

TEST(ReorderBuffer, CopiesTellHowLongTheyTake) {
  ReorderBuffer buffer({.seconds = 0.1});
  double now = 0;
  for (int i = 0; i < 50; ++i, now += 0.04) {
    if (i != 40) add(buffer, i, now);
    if (i >= 10) add(buffer, i - 10, now);  // 0.4 s behind
    take(buffer, now);
  }
  take(buffer, now);
  add(buffer, 40, now);
  EXPECT_THAT(take(buffer, now), ElementsAre(40, 41, 42, 43, 44, 45, 46, 47, 48, 49));
  EXPECT_EQ(buffer.counts().lost, 0);
}

TEST(ReorderBuffer, PatienceHasABound) {
  ReorderBuffer buffer({.seconds = 0.1, .most_seconds = 1});
  double now = 0;
  for (int i = 0; i < 200; ++i, now += 0.04) {
    if (i % 60 != 0 || i == 0) add(buffer, i, now);
    if (i % 60 == 59 && i > 60) add(buffer, i - 59, now);
    take(buffer, now);
  }
  EXPECT_EQ(buffer.wait(), 1);
  EXPECT_EQ(ReorderBuffer({.seconds = 3}).wait(), 3);
}

TEST(ReorderBuffer, HoldsAtMostSoManyBytes) {
  ReorderBuffer buffer = begun(0, {.seconds = 10, .bytes = 100000});
  for (int i = 2; i < 20; ++i) {
    RtpPacket packet;
    packet.sequence = std::uint16_t(i);
    packet.payload.resize(60000);
    buffer.add(packet, 0);
    if (i > 2) continue;
    EXPECT_THAT(take(buffer, 0), IsEmpty());
  }
  EXPECT_EQ(take(buffer, 0).size(), 19u);
}

TEST(JitterMeter, IsZeroForEvenArrivalsAndThatOfTheRfcElse) {
  JitterMeter even;
  for (int i = 0; i < 100; ++i) even.add(std::uint32_t(0xFFFFF000 + 3600 * i), i * 0.04, 90000);
  EXPECT_LT(even.ticks(), 1e-3);
  JitterMeter late;
  late.add(0, 0, 90000);
  late.add(3600, 0.05, 90000);  // 10 ms late: 900 ticks, of which a sixteenth counts
  EXPECT_NEAR(late.ticks(), 900 / 16.0, 1e-6);
}

TEST(Unwrapper, GoesOnOverTheWrapBothWays) {
  Unwrapper unwrapper;
  const std::int64_t first = unwrapper.add(0xFFFFFFF0);
  EXPECT_EQ(unwrapper.add(0x10) - first, 0x20);
  EXPECT_EQ(unwrapper.add(0xFFFFFFF8) - first, 8);
}

}  // namespace rtp_reorder_test
}  // namespace animeme::media
