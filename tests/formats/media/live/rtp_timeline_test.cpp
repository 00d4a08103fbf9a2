#include "tools/formats/media/rtp/rtp_timeline.h"

#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"
#include "tools/formats/media/rtp/rtp_units.h"

namespace animeme::media {
namespace rtp_timeline_test {

constexpr std::uint32_t kFace = 90000;
constexpr std::uint32_t kSound = 48000;

// 100 s after 1900 at time 0; the face's RTP time is then 1000, the sound's -500.
SenderInfo face_report(double seconds) {
  return {std::uint64_t((100 + seconds) * 4294967296.0), std::uint32_t(1000 + kFace * seconds), 0,
          0};
}
SenderInfo sound_report(double seconds) {
  return {std::uint64_t((100 + seconds) * 4294967296.0), std::uint32_t(-500 + kSound * seconds), 0,
          0};
}

TEST(RtpTimeline, ReportsTieTheTracksToTheTick) {
  for (const bool before : {true, false}) {
    RtpTimeline timeline(kFace, kSound, 0.5);
    if (before) timeline.add_report(LiveTrack::face, face_report(7));
    // The first plane is that of second 8, the first sound that of 8.5.
    const auto face = timeline.add(LiveTrack::face, 1000 + kFace * 8, 0);
    if (!before) timeline.add_report(LiveTrack::face, face_report(8.25));
    EXPECT_FALSE(timeline.settle(0.1));
    timeline.add_report(LiveTrack::audio, sound_report(9));
    const auto sound = timeline.add(LiveTrack::audio, std::uint32_t(-500 + 408000), 0.2);
    ASSERT_TRUE(timeline.settle(0.2));
    EXPECT_EQ(timeline.sync(), RtpSync::reports);
    EXPECT_EQ(timeline.time(LiveTrack::face, face), 0);
    EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 24000);
  }
}

TEST(RtpTimeline, TheDescriptionIsBelievedAtOnce) {
  RtpTimeline timeline(kFace, kSound, 0.5);
  timeline.describe(LiveTrack::face, 0xFFFFFFF0);
  timeline.describe(LiveTrack::audio, 2000);
  const auto face = timeline.add(LiveTrack::face, 0xFFFFFFF0 + 3600, 0);
  ASSERT_TRUE(timeline.settle(0));
  EXPECT_EQ(timeline.sync(), RtpSync::description);
  EXPECT_EQ(timeline.time(LiveTrack::face, face), 3600);
  const auto sound = timeline.add(LiveTrack::audio, 2000 - 1024, 0);
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), -1024);
}

TEST(RtpTimeline, WithoutReportsWhatComesTogetherBelongsTogether) {
  RtpTimeline timeline(kFace, kSound, 0.5);
  const auto face = timeline.add(LiveTrack::face, 77, 10);
  const auto sound = timeline.add(LiveTrack::audio, 5, 10.25);
  EXPECT_FALSE(timeline.settle(10.4));
  EXPECT_DOUBLE_EQ(timeline.deadline().value_or(0), 10.5);
  ASSERT_TRUE(timeline.settle(10.5));
  EXPECT_EQ(timeline.sync(), RtpSync::arrival);
  EXPECT_EQ(timeline.time(LiveTrack::face, face), 0);
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 12000);

  // Reports correct the sound from then on; the face stays.
  timeline.add_report(LiveTrack::face, {1000ull << 32, 77, 0, 0});
  timeline.add_report(LiveTrack::audio, {1000ull << 32, 5, 0, 0});
  EXPECT_EQ(timeline.sync(), RtpSync::reports);
  EXPECT_EQ(timeline.time(LiveTrack::face, face), 0);
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 0);
  // Later ones that differ by little do not.
  timeline.add_report(LiveTrack::audio, {1000ull << 32, 5 + 480, 0, 0});
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 0);
  // Nor does one that differs by much: three in a row have to agree.
  for (const std::uint32_t off : {4800, 9600, 4800, 4800}) {
    timeline.add_report(LiveTrack::audio, {1000ull << 32, 5 + off, 0, 0});
    EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 0);
  }
  timeline.add_report(LiveTrack::audio, {1000ull << 32, 5 + 4800, 0, 0});
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), -4800);
}

TEST(RtpTimeline, ReportsThatContradictTheArrivalByFarAreNotBelieved) {
  RtpTimeline timeline(kFace, kSound, 0.5);
  const auto face = timeline.add(LiveTrack::face, 77, 10);
  const auto sound = timeline.add(LiveTrack::audio, 5, 10);
  timeline.add_report(LiveTrack::face, {1000ull << 32, 77, 0, 0});
  for (int i = 0; i < 5; ++i) timeline.add_report(LiveTrack::audio, {5000ull << 32, 5, 0, 0});
  ASSERT_TRUE(timeline.settle(11));
  for (int i = 0; i < 5; ++i) timeline.add_report(LiveTrack::audio, {9000ull << 32, 5, 0, 0});
  EXPECT_EQ(timeline.time(LiveTrack::face, face), 0);
  EXPECT_EQ(timeline.time(LiveTrack::audio, sound), 0);
}

TEST(RtpTimeline, OneTrackBeginsAtZeroAtOnce) {
  RtpTimeline timeline(kFace, 0, 0.5);
  EXPECT_FALSE(timeline.settle(0));
  const auto first = timeline.add(LiveTrack::face, 123456, 0);
  ASSERT_TRUE(timeline.settle(0));
  EXPECT_EQ(timeline.time(LiveTrack::face, first), 0);
  const auto next = timeline.add(LiveTrack::face, 123456 + 3600, 0);
  EXPECT_EQ(timeline.time(LiveTrack::face, next), 3600);
}

TEST(RtpTimeline, TimesGoOnOverTheWrap) {
  RtpTimeline timeline(kFace, 0, 0.5);
  std::int64_t last = 0;
  for (std::uint64_t i = 0; i < 30; ++i) {  // an hour a step: more than two wraps
    last = timeline.add(LiveTrack::face, std::uint32_t(i * 3600 * kFace), double(i));
    timeline.settle(double(i));
  }
  EXPECT_EQ(timeline.time(LiveTrack::face, last), 29ll * 3600 * kFace);
}

TEST(Timescale, TimesUpTo90000ComeBackExactly) {
  for (const std::uint32_t scale : {1u, 10000u, 12500u, 24000u, 25000u, 30000u, 44100u, 90000u}) {
    for (std::int64_t time = -100; time < 200000; time += 37) {
      ASSERT_EQ(to_timescale(from_timescale(time, scale), scale, std::nullopt), time) << scale;
    }
  }
}

TEST(Timescale, FinerTimesComeBackOnTheGridOfPlanes) {
  const fap::Rate rate = fap::make_rate(479, 16);  // 29 15/16
  for (std::int64_t plane = 0; plane < 100000; ++plane) {
    const std::int64_t time = plane * 16000;
    ASSERT_EQ(to_timescale(from_timescale(time, 479000), 479000, rate), time);
  }
  EXPECT_EQ(to_timescale(3000, 479000, std::nullopt), 15967);
}

}  // namespace rtp_timeline_test
}  // namespace animeme::media
