#include "dam/speaking/idle_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace idle_motion_test {

Signal mouth(std::size_t frames, std::vector<std::string> names = {"fap3_open_jaw"}) {
  Signal signal;
  signal.rate = {50, 1};
  signal.names = std::move(names);
  signal.values.assign(frames * signal.names.size(), 7.0);
  return signal;
}

/// Two phrases with a pause from 2 to 3 s; the AY from 1.0 to 1.3 s is drawn out.
Script phrases() {
  return {{{0, 0.5, "SIL", ""},
           {0.5, 0.6, "AE", "at"},
           {0.6, 1.0, "T", "at"},
           {1.0, 1.3, "AY", "eye"},
           {1.3, 2.0, "T", "eye"},
           {2.0, 3.0, "SIL", ""},
           {3.0, 3.1, "AE", "at"},
           {3.1, 3.5, "T", "at"},
           {3.5, 20.0, "SIL", ""}}};
}

std::size_t channel(const Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c)
    if (fap_of_channel(signal.names[c]) == fap) return c;
  ADD_FAILURE() << "no FAP " << fap;
  return 0;
}

TEST(IdleMotion, BlinksInThePauseAndEverySoOften) {
  Signal signal = mouth(1000);
  const auto report = add_idle_motion(signal, phrases());
  ASSERT_TRUE(report) << report.error().describe();
  const std::size_t lid = channel(signal, 19), lower = channel(signal, 21);
  std::vector<double> closed;  // times at which the lids meet
  bool shut = false;
  for (std::size_t i = 0; i < 1000; ++i) {
    const bool now = signal.at(i, lid) + signal.at(i, lower) > 1000;
    if (now && !shut) closed.push_back(signal.time(i));
    shut = now;
  }
  EXPECT_EQ(closed.size(), report->blinks);
  EXPECT_GE(closed.size(), 3u);
  EXPECT_LE(closed.size(), 10u);
  for (std::size_t i = 1; i < closed.size(); ++i) {
    EXPECT_GE(closed[i] - closed[i - 1], 0.98);
    EXPECT_LE(closed[i] - closed[i - 1], 7.1);
  }
  EXPECT_TRUE(
      std::any_of(closed.begin(), closed.end(), [](double t) { return t > 2.05 && t < 2.3; }));
  EXPECT_EQ(signal.at(0, lid), 0);
  EXPECT_EQ(signal.at(999, lid), 0);
}

TEST(IdleMotion, BrowsRiseAtTheDrawnOutVowel) {
  Signal signal = mouth(1000);
  const auto report = add_idle_motion(signal, phrases());
  ASSERT_TRUE(report);
  EXPECT_EQ(report->accents, 2u);  // one a phrase
  const std::size_t brow = channel(signal, 31);
  EXPECT_GT(signal.at(57, brow), 50);  // 1.14 s, the middle of AY
  EXPECT_EQ(signal.at(30, brow), 0);   // 0.6 s: the other vowel of the phrase has none
  EXPECT_EQ(signal.at(120, brow), 0);  // the pause
  const std::size_t pitch = channel(signal, 48);
  EXPECT_GT(signal.at(57, pitch) - signal.at(120, pitch), 0);  // positive is down
}

TEST(IdleMotion, KeepsWhatTheCharacterHasLearned) {
  Signal signal = mouth(100, {"fap3_open_jaw", "fap31_raise_l_i_eyebrow"});
  ASSERT_TRUE(add_idle_motion(signal, phrases()));
  EXPECT_EQ(signal.names.size(), 2u + 12u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(signal.at(i, 0), 7);
    EXPECT_EQ(signal.at(i, 1), 7);
  }
}

TEST(IdleMotion, SeedsDifferAndRepeat) {
  const auto make = [](std::uint64_t seed) {
    Signal signal = mouth(1000);
    EXPECT_TRUE(add_idle_motion(signal, phrases(), {1, seed}));
    return signal.values;
  };
  EXPECT_EQ(make(3), make(3));
  EXPECT_NE(make(3), make(4));
}

TEST(IdleMotion, MovesGentlyAndWithinWhatCanBeCoded) {
  Signal signal = mouth(1000);
  ASSERT_TRUE(add_idle_motion(signal, phrases(), {2, 1}));
  for (const int fap : {48, 49, 50}) {
    const std::size_t c = channel(signal, fap);
    for (std::size_t i = 1; i < 1000; ++i) {
      EXPECT_LT(std::abs(signal.at(i, c)), 10 * 1745.4);  // ten degrees
      EXPECT_LT(std::abs(signal.at(i, c) - signal.at(i - 1, c)), 0.6 * 1745.4);
    }
  }
}

TEST(IdleMotion, ChecksWhatItGets) {
  Signal rig = mouth(10, {"snout"});
  EXPECT_EQ(add_idle_motion(rig, phrases()).error().code, Code::unsupported);
  Signal signal = mouth(10);
  EXPECT_FALSE(add_idle_motion(signal, phrases(), {-1, 1}));
  EXPECT_FALSE(add_idle_motion(signal, phrases(), {std::nan(""), 1}));
  signal.first_frame = 3;
  EXPECT_FALSE(add_idle_motion(signal, phrases()));
  Signal still = mouth(100);
  EXPECT_TRUE(add_idle_motion(still, {{{0, 2, "SIL", ""}}}));  // silence blinks, too
}

TEST(IdleMotion, ArkitShapesHaveIt) {
  Signal signal = mouth(500, {"JawOpen", "EyeBlinkLeft", "EyeWideLeft", "BrowInnerUp"});
  for (std::size_t i = 0; i < 500; ++i) {
    signal.at(i, 0) = 0.3;
    signal.at(i, 1) = 0.1;
    signal.at(i, 2) = 0.2;
    signal.at(i, 3) = 0.05;
  }
  const auto report = add_idle_motion(signal, phrases());
  ASSERT_TRUE(report) << report.error().describe();
  const std::vector<std::string> wanted = {
      "JawOpen",         "EyeBlinkLeft",     "EyeWideLeft", "BrowInnerUp", "EyeBlinkRight",
      "BrowOuterUpLeft", "BrowOuterUpRight", "HeadPitch",   "HeadYaw",     "HeadRoll"};
  EXPECT_EQ(signal.names, wanted);
  double left = 0, right = 0, brow = 0, head = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_EQ(signal.at(i, 0), 0.3);
    EXPECT_GE(signal.at(i, 1), 0.1) << "its own lids stay at least as far closed";
    EXPECT_NEAR(signal.at(i, 2), 0.2 * (1 - signal.at(i, 4)), 1e-12) << "wide gives way";
    EXPECT_GE(signal.at(i, 3), 0.05);
    left = std::max(left, signal.at(i, 1));
    right = std::max(right, signal.at(i, 4));
    brow = std::max(brow, signal.at(i, 3));
    head = std::max(head, std::abs(signal.at(i, 7)));
  }
  EXPECT_DOUBLE_EQ(left, 1);
  EXPECT_DOUBLE_EQ(right, 1);
  EXPECT_GT(brow, 0.1);
  EXPECT_LT(brow, 0.9);
  EXPECT_GT(head, 0.01);
  EXPECT_LT(head, 0.1) << "radians";
}

TEST(IdleMotion, ArkitAndFapsMoveAlike) {
  Signal shapes = mouth(500, {"jawOpen"}), faps = mouth(500);
  std::fill(shapes.values.begin(), shapes.values.end(), 0.0);
  ASSERT_TRUE(add_idle_motion(shapes, phrases()));
  ASSERT_TRUE(add_idle_motion(faps, phrases()));
  const auto clip = to_sequence(shapes);
  ASSERT_TRUE(clip);
  for (const int fap : {31, 48, 49, 50}) {
    for (std::size_t i = 0; i < 500; ++i)
      EXPECT_NEAR(clip->frames[i].value[std::size_t(fap)], faps.at(i, channel(faps, fap)), 3)
          << "FAP " << fap << ", frame " << i;
  }
}

}  // namespace idle_motion_test
}  // namespace animeme::dam
