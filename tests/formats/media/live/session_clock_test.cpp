// What a receiver believes of the times that senders claim.
#include "tools/formats/media/rtp/session_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"
#include "tests/support/audio_formats.h"
#include "tools/formats/media/live/live_frames.h"

namespace animeme::media {
namespace session_clock_test {

constexpr std::uint32_t kScale = 25000;
constexpr int kRate = 48000;

LiveInfo info_of(std::uint32_t timescale = kScale) {
  return {{1}, timescale, 0x61, test::aac_format()};
}

LiveUnit face(double seconds, bool intra = true, std::uint32_t timescale = kScale) {
  return {LiveTrack::face, {1}, intra, std::llround(seconds * timescale), timescale / 25};
}

LiveUnit sound(double seconds) {
  return {LiveTrack::audio, {1}, false, std::llround(seconds * kRate), 1024};
}

// What comes out, in seconds; a gap of the face as -100, of the sound as -200.
struct Story {
  SessionClock clock;
  std::vector<double> face_times, sound_times;
  std::vector<LiveInfo> infos;
  int face_gaps = 0;

  void push(LiveEvent event, double now) {
    std::deque<LiveEvent> out;
    clock.push(std::move(event), now, out);
    for (const LiveEvent& each : out) {
      if (const auto* info = std::get_if<LiveInfo>(&each)) infos.push_back(*info);
      if (const auto* gap = std::get_if<LiveGap>(&each)) face_gaps += gap->track == LiveTrack::face;
      EXPECT_FALSE(std::holds_alternative<LiveRestart>(each));
      const auto* unit = std::get_if<LiveUnit>(&each);
      if (unit == nullptr) continue;
      const bool is_face = unit->track == LiveTrack::face;
      auto& times = is_face ? face_times : sound_times;
      const double time = double(unit->time) / (is_face ? infos.back().timescale : kRate);
      EXPECT_TRUE(times.empty() || time > times.back()) << time;
      times.push_back(time);
    }
  }
  // 25 planes a second from `begin` of the sender on, as they would come from `now` on.
  double talk(double begin, double seconds, double now, bool with_sound = false) {
    for (int i = 0; i < std::lround(seconds * 25); ++i, now += 0.04) {
      if (with_sound) push(sound(begin + i * 0.04), now);
      push(face(begin + i * 0.04), now);
    }
    return now;
  }
  double reached() const { return face_times.empty() ? 0 : face_times.back(); }
};

TEST(SessionClock, LeavesTheTimesOfASenderAsTheyAre) {
  for (const double speed : {1.0, 1000.0}) {  // in its time, and a file as fast as it goes
    Story story;
    story.push(info_of(), 0);
    story.push(sound(-0.02), 0);
    for (int i = 0; i < 5000; ++i) {
      story.push(face(7 + i * 0.04), 100 + i * 0.04 / speed);
      story.push(sound(7 + i * 0.04), 100 + i * 0.04 / speed);
    }
    ASSERT_EQ(story.face_times.size(), 5000u);
    EXPECT_EQ(story.sound_times.size(), 5001u);
    EXPECT_DOUBLE_EQ(story.face_times.front(), 7);
    EXPECT_DOUBLE_EQ(story.reached(), 7 + 4999 * 0.04);
    EXPECT_EQ(story.clock.sessions(), 1);
    EXPECT_EQ(story.clock.refused(), 0);
  }
}

TEST(SessionClock, GapsAreAsLongAsTheTimeThatHasPassed) {
  Story story;
  story.push(info_of(), 0);
  story.talk(0, 2, 0);
  story.talk(602, 2, 602);  // ten minutes of silence, in which the sender's clock went on
  EXPECT_EQ(story.face_times.size(), 100u);
  EXPECT_NEAR(story.reached(), 603.96, 1e-9);
  EXPECT_EQ(story.clock.sessions(), 1);
}

// Each plane an hour behind the one before: nothing confirms any of them.
TEST(SessionClock, ClaimsAloneCostNothing) {
  Story story;
  story.push(info_of(), 0);
  double now = story.talk(0, 1, 0);
  for (int i = 0; i < 10000; ++i) story.push(face(3600.0 * (i + 1)), now += 0.001);
  EXPECT_LE(story.reached(), now + 6);
  EXPECT_GT(story.clock.refused(), 9000);
  // Nor does a clock that runs much faster than time, in steps that confirm each other.
  Story fast;
  fast.push(info_of(), 0);
  for (int i = 0; i < 10000; ++i) fast.push(face(0.9 * i), 0.001 * i);
  EXPECT_LT(fast.reached(), 10 + 6 + 10);
  // A single one elsewhere changes nothing.
  Story stray;
  stray.push(info_of(), 0);
  now = stray.talk(0, 1, 0);
  stray.push(face(1e6), now);
  stray.push(face(-1e6), now);
  stray.talk(1, 1, now);
  EXPECT_EQ(stray.face_times.size(), 50u);
  EXPECT_EQ(stray.clock.sessions(), 1);
  EXPECT_EQ(stray.clock.refused(), 2);
}

// Planes of 0.04 s that are 0.24 s apart leave gaps, however regular these are.
TEST(SessionClock, SmallGapsAreBoundedByTimeAsLargeOnesAre) {
  Story story;
  story.push(info_of(), 0);
  for (int i = 0; i < 80000; ++i) story.push(face(0.24 * i), 1e-4 * i);  // 5.3 hours in 8 s
  EXPECT_LT(story.reached(), 8 + 6 + 8);
  // In their own time they are what they always were: a head that is shown four times a second.
  Story slow;
  slow.push(info_of(), 0);
  for (int i = 0; i < 80000; ++i) slow.push(face(0.24 * i), 0.24 * i);
  EXPECT_EQ(slow.face_times.size(), 80000u);
  EXPECT_EQ(slow.clock.refused(), 0);
}

// Nor is the length that units claim believed without end, nor that of many new senders.
TEST(SessionClock, NothingRunsMoreThanAnHourAhead) {
  for (const bool restarts : {false, true}) {
    Story story;
    story.push(info_of(), 0);
    for (int i = 0; i < 100000; ++i) {
      LiveUnit unit = face(0.24 * (restarts ? i % 7 : i));
      unit.duration = kScale / 4;
      if (restarts && i % 7 == 0) story.push(LiveRestart{}, 1e-4 * i);
      story.push(unit, 1e-4 * i);
    }
    EXPECT_GT(story.reached(), 3500) << restarts;
    EXPECT_LT(story.reached(), 3600 + 11) << restarts;
  }
}

TEST(SessionClock, AClockThatJumpsGoesOnByArrival) {
  for (const double jump : {-500.0, -3.0, 4000.0, 1e7}) {
    Story story;
    story.push(info_of(), 0);
    double now = story.talk(1000, 10, 50, true);
    now += 2;
    story.talk(1010 + jump, 10, now, true);
    ASSERT_EQ(story.face_times.size(), 500u) << jump;
    EXPECT_NEAR(story.face_times[250], 1012, 0.3) << jump;
    EXPECT_NEAR(story.reached(), 1022, 0.3) << jump;
    EXPECT_GT(story.face_gaps, 0) << "what follows may be of another sender";
    EXPECT_EQ(story.clock.sessions(), 2) << jump;
    // Face and sound stay together.
    ASSERT_GT(story.sound_times.size(), 490u);
    EXPECT_NEAR(story.sound_times.back(), story.reached(), 0.001) << jump;
  }
}

TEST(SessionClock, ASenderThatRestartsGoesOnAtOnce) {
  Story story;
  story.push(info_of(), 0);
  double now = story.talk(0, 20, 0, true);
  story.push(LiveRestart{}, now);
  story.push(info_of(), now += 3);
  story.talk(0, 5, now, true);
  EXPECT_EQ(story.face_times.size(), 625u);
  EXPECT_EQ(story.sound_times.size(), 625u);
  EXPECT_NEAR(story.face_times[500], 23, 0.001);
  EXPECT_NEAR(story.reached(), 27.96, 0.001);
  EXPECT_EQ(story.face_gaps, 1);
  EXPECT_EQ(story.clock.sessions(), 2);
  EXPECT_EQ(story.infos.size(), 1u);
  // Once more, sooner than what was given out has been: no overlap.
  Story quick;
  quick.push(info_of(), 0);
  now = quick.talk(0, 20, 0) - 19.5;
  quick.push(LiveRestart{}, now);
  quick.talk(0, 1, now);
  EXPECT_EQ(quick.face_times.size(), 525u);
  EXPECT_GT(quick.face_times[500], 19.96);
}

TEST(SessionClock, ASenderWithAnotherTimeScaleIsConverted) {
  Story story;
  story.push(info_of(), 0);
  story.talk(0, 1, 0);
  story.push(LiveRestart{}, 1.5);
  LiveInfo other = info_of(90000);
  other.audio->priming = 0;
  story.push(other, 1.5);
  for (int i = 0; i < 25; ++i) story.push(face(i * 0.04, true, 90000), 2 + i * 0.04);
  EXPECT_EQ(story.infos.size(), 1u) << "the receiver sees one presentation";
  EXPECT_EQ(story.face_times.size(), 50u);
  EXPECT_NEAR(story.reached(), 2.96, 0.001);
}

TEST(SessionClock, TheSoundAloneIsMovedAndTheFaceStays) {
  Story story;
  story.push(info_of(), 0);
  double now = story.talk(0, 5, 0, true);
  for (int i = 0; i < 250; ++i, now += 0.04) {  // the sound is 0.5 s earlier from now on
    story.push(sound(4.5 + i * 0.04), now);
    story.push(face(5 + i * 0.04), now);
  }
  EXPECT_EQ(story.face_times.size(), 375u);
  EXPECT_EQ(story.face_gaps, 0);
  EXPECT_EQ(story.clock.sessions(), 1);
  EXPECT_NEAR(story.sound_times.back(), story.reached() - 0.5, 0.001);
}

TEST(SessionClock, TimesBeyondAllMeaningAreSurvived) {
  Story story;
  story.push(info_of(), 0);
  for (int i = 0; i < 100; ++i) {
    LiveUnit unit = face(0);
    unit.time = i % 2 == 0 ? INT64_MAX - i : INT64_MIN + i;
    unit.duration = INT64_MAX;
    story.push(unit, i * 0.01);
    unit.track = LiveTrack::audio;
    story.push(unit, i * 0.01);
  }
  double now = story.talk(3, 2, 2);
  EXPECT_GT(story.face_times.size(), 45u);
  EXPECT_LT(story.reached(), now + 6);
  for (const LiveInfo& info : story.infos) EXPECT_EQ(info.timescale, kScale);
}

// Text with every frame is what costs most of what a gap claims.
TEST(SessionClock, TextIsNoLongerThanTheTime) {
  test::LiveTalk talk = test::random_talk(20, 5);
  SessionClock clock;
  LiveFrames frames(GapRule::hold, fap::FillOptions{});
  std::deque<LiveEvent> out;
  clock.push(talk.info, 0, out);
  for (std::size_t i = 0; i < talk.units.size(); ++i) {
    talk.units[i].time = std::int64_t(i) * 3600 * talk.info.timescale;
    clock.push(talk.units[i], 0.04 * double(i), out);
  }
  std::size_t shown = 0;
  for (const LiveEvent& event : out) {
    const auto* unit = std::get_if<LiveUnit>(&event);
    if (unit != nullptr) shown += frames.push(*unit, talk.info.timescale, true).size();
  }
  EXPECT_LT(shown, 200u);
}

}  // namespace session_clock_test
}  // namespace animeme::media
