#include "tools/formats/media/live/presentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/live/loopback.h"

namespace animeme::media {
namespace presentation_test {

EncodedAudio make_sound(int packets, int rate = 48000, int frame = 1024, int priming = 1024) {
  EncodedAudio sound;
  sound.format.sample_rate = rate;
  sound.format.frame_samples = frame;
  sound.format.priming = priming;
  for (int i = 0; i < packets; ++i) {
    sound.packets.push_back({{std::uint8_t(i), 7}, i * std::int64_t(frame) - priming, frame});
  }
  sound.length = (packets - 1) * std::int64_t(frame);
  return sound;
}

std::vector<LiveUnit> take_all(LiveInput& input, std::size_t most = 1000000) {
  std::vector<LiveUnit> all;
  while (const auto due = input.next_due()) {
    auto units = input.take(*due);
    EXPECT_TRUE(units);
    EXPECT_FALSE(units->empty());
    all.insert(all.end(), units->begin(), units->end());
    if (all.size() >= most) break;
  }
  return all;
}

std::vector<LiveUnit> of(const std::vector<LiveUnit>& units, LiveTrack track) {
  std::vector<LiveUnit> chosen;
  for (const LiveUnit& unit : units)
    if (unit.track == track) chosen.push_back(unit);
  return chosen;
}

TEST(ClipInput, GivesEveryUnitOnceInOrderOfItsInstant) {
  const fba::AccessUnits face = test::make_face(50);
  const EncodedAudio sound = make_sound(96);
  ClipInput input(face, sound, {.audio_ahead = 0.05});
  EXPECT_EQ(input.info().face_config, face.config);
  EXPECT_EQ(input.info().audio, sound.format);
  EXPECT_NEAR(*input.next_due(), -1024.0 / 48000 - 0.05, 1e-9);
  const auto all = take_all(input);
  const auto planes = of(all, LiveTrack::face);
  const auto packets = of(all, LiveTrack::audio);
  ASSERT_EQ(planes.size(), face.units.size());
  ASSERT_EQ(packets.size(), sound.packets.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(planes[i].bytes, face.units[i].bytes);
    EXPECT_EQ(planes[i].time, face.units[i].time);
    EXPECT_EQ(planes[i].intra, face.units[i].intra);
  }
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i].bytes, sound.packets[i].bytes);
    EXPECT_EQ(packets[i].time, sound.packets[i].time);
  }
  double last = -1;
  for (const LiveUnit& unit : all) {
    const double due = seconds_of(input.info(), unit.track, unit.time) -
                       (unit.track == LiveTrack::audio ? 0.05 : 0);
    EXPECT_GE(due, last);
    last = due;
  }
}

TEST(ClipInput, TakeGivesWhatIsDueAndNoMore) {
  ClipInput input(test::make_face(50), {});
  EXPECT_TRUE(input.take(-0.001)->empty());
  EXPECT_EQ(input.take(0.1)->size(), 3u);  // 0, 0.04, 0.08
  EXPECT_NEAR(*input.next_due(), 0.12, 1e-12);
  EXPECT_EQ(input.take(1e9)->size(), 47u);
  EXPECT_FALSE(input.next_due());
}

TEST(ClipInput, ARepeatGoesOnOnTheGridOfThePlanesWithoutMeetingTheSound) {
  const fba::AccessUnits face = test::make_face(50);  // 2 s
  const EncodedAudio sound = make_sound(96);          // to 2.027 s, priming of 0.021 s
  ClipInput input(face, sound, {.loop = true});
  const auto all = take_all(input, 600);
  const auto planes = of(all, LiveTrack::face);
  const auto packets = of(all, LiveTrack::audio);
  ASSERT_GT(planes.size(), 150u);
  // 2.027 + 0.021 s, up to whole planes: 52 of them.
  EXPECT_EQ(planes[50].time, 52 * 1000);
  EXPECT_EQ(planes[100].time, 104 * 1000);
  EXPECT_EQ(packets[96].time, 2 * 48000 + 3840 - 1024);
  for (std::size_t i = 1; i < packets.size(); ++i) {
    EXPECT_GE(packets[i].time, packets[i - 1].time + packets[i - 1].duration);
  }
  // One object start code in the stream.
  EXPECT_EQ(planes[0].bytes, face.units[0].bytes);
  const test::Bytes rest(face.units[0].bytes.begin() + 5, face.units[0].bytes.end());
  EXPECT_EQ(planes[50].bytes, rest);
  EXPECT_TRUE(planes[50].intra);
  EXPECT_EQ(planes[51].bytes, face.units[1].bytes);
}

TEST(ClipInput, RepeatsDoNotDriftWhereSampleAndTickDoNotMeet) {
  const fba::AccessUnits face = test::make_face(31, 30000, 1001);
  ClipInput input(face, make_sound(40, 44100), {.loop = true});
  const auto all = take_all(input, 40000);
  const auto planes = of(all, LiveTrack::face);
  const auto packets = of(all, LiveTrack::audio);
  for (std::size_t round = 1; round * 31 < planes.size() && round * 40 < packets.size(); ++round) {
    const double start = double(planes[round * 31].time) / 30000;
    const double heard = double(packets[round * 40].time + 1024) / 44100;
    ASSERT_NEAR(start, heard, 0.51 / 44100);
  }
}

TEST(ClipInput, EndsAtTheDuration) {
  ClipInput input(test::make_face(50), make_sound(96), {.loop = true, .duration = 5});
  const auto all = take_all(input);
  const auto planes = of(all, LiveTrack::face);
  EXPECT_LT(planes.back().time, 5 * 25000);
  EXPECT_GE(planes.back().time, 5 * 25000 - 3000);
  EXPECT_LT(of(all, LiveTrack::audio).back().time, 5 * 48000);
}

TEST(ClipInput, SoundAloneAndNothingAtAll) {
  ClipInput sound({}, make_sound(10));
  EXPECT_TRUE(sound.info().face_config.empty());
  EXPECT_EQ(take_all(sound).size(), 10u);
  ClipInput nothing({}, {});
  EXPECT_FALSE(nothing.next_due());
}

TEST(Loopback, CarriesEverythingInOrder) {
  Loopback joined = make_loopback();
  ClipInput input(test::make_face(50), make_sound(96));
  ASSERT_TRUE(joined.sink->start(input.info()));
  const auto all = take_all(input);
  for (const LiveUnit& unit : all) ASSERT_TRUE(joined.sink->send(unit));
  ASSERT_TRUE(joined.sink->finish());
  EXPECT_EQ(std::get<LiveInfo>(*joined.source->next(0)), input.info());
  for (const LiveUnit& unit : all) EXPECT_EQ(std::get<LiveUnit>(*joined.source->next(0)), unit);
  EXPECT_TRUE(std::holds_alternative<LiveEnd>(*joined.source->next(0)));
  EXPECT_TRUE(std::holds_alternative<LiveIdle>(*joined.source->next(0)));
  EXPECT_EQ(joined.sink->stats().face_units, 50);
  EXPECT_EQ(joined.source->stats().packets, 146);
}

TEST(Loopback, LosesTheShareAskedForAndSaysSo) {
  Loopback joined = make_loopback({.loss = 0.1, .seed = 5});
  ClipInput input(test::make_face(2000), {});
  ASSERT_TRUE(joined.sink->start(input.info()));
  for (const LiveUnit& unit : take_all(input)) ASSERT_TRUE(joined.sink->send(unit));
  std::int64_t came = 0, gaps = 0;
  for (;;) {
    const auto event = joined.source->next(0);
    if (std::holds_alternative<LiveIdle>(*event)) break;
    if (const auto* gap = std::get_if<LiveGap>(&*event)) gaps += gap->packets;
    came += std::holds_alternative<LiveUnit>(*event);
  }
  EXPECT_NEAR(double(came), 1800, 60);
  EXPECT_LE(came + gaps, 2000);
  EXPECT_GE(came + gaps, 1990);  // losses at the very end show in no gap
  EXPECT_EQ(joined.source->stats().lost, 2000 - came);
}

}  // namespace presentation_test
}  // namespace animeme::media
