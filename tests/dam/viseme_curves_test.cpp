// Scripts as weights of visemes: what touches is shown alone, vowels dominate, nothing jumps.
#include "dam/speaking/viseme_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "dam/script/phones.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace viseme_curves_test {

using test::script_of;
using test::Sounds;

// Any sounds, some of them very short.
Script any_script(unsigned seed) {
  std::mt19937 random(seed);
  Sounds sounds{{"SIL", 0.2}};
  for (int i = 0; i < 60; ++i) {
    const auto& phone = phones()[random() % kPhoneCount];
    sounds.emplace_back(phone.label, 0.03 + double(random() % 200) / 1000);
  }
  sounds.emplace_back("SIL", 0.3);
  return script_of(sounds);
}

fap::Sequence frames_of(double seconds, fap::Rate rate) {
  fap::Sequence clip{rate, {}, ""};
  for (int i = 0; i < int(seconds * rate.frames_per_second()); ++i) {
    clip.frames.emplace_back();
    clip.frames.back().number = i;
  }
  return clip;
}

TEST(VisemeCurves, TheSumIsOneAndNothingJumps) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Script script = any_script(seed);
    const VisemeCurves curves(script);
    fap::VisemeWeights before = curves.at(-1);
    EXPECT_EQ(before[0], 1);
    constexpr double kStep = 0.0005;
    for (double t = -0.5; t < script.duration() + 0.5; t += kStep) {
      const fap::VisemeWeights now = curves.at(t);
      EXPECT_NEAR(std::accumulate(now.begin(), now.end(), 0.0), 1, 1e-9);
      for (std::size_t v = 0; v < now.size(); ++v) {
        EXPECT_GE(now[v], -1e-12);
        EXPECT_LT(std::abs(now[v] - before[v]), 0.15) << seed << " " << t << " viseme " << v;
      }
      before = now;
    }
    EXPECT_EQ(before[0], 1);
  }
}

// A frame of 25 a second sees each P, F and TH alone, however short it is.
TEST(VisemeCurves, WhatTouchesIsShownAlone) {
  for (const auto& [label, viseme] :
       {std::pair{"P", 1}, {"B", 1}, {"M", 1}, {"F", 2}, {"V", 2}, {"TH", 3}, {"DH", 3}}) {
    for (int i = 0; i < 20; ++i) {
      const double length = 0.03 + 0.004 * i;
      const Script script = script_of(
          {{"SIL", 0.2 + 0.0031 * i}, {"AA", 0.15}, {label, length}, {"UW", 0.12}, {"SIL", 0.3}});
      double most = 0;
      for (const auto& weights : viseme_weights(script, frames_of(script.duration(), {25, 1}))) {
        most = std::max(most, weights[std::size_t(viseme)]);
      }
      EXPECT_NEAR(most, 1, 1e-9) << label << " of " << length << " s";
    }
  }
}

// Also of two that follow each other.
TEST(VisemeCurves, TwoThatTouchAreBothSeen) {
  const Script script =
      script_of({{"SIL", 0.3}, {"IY", 0.2}, {"M", 0.08}, {"F", 0.08}, {"IY", 0.2}, {"SIL", 0.3}});
  const VisemeCurves curves(script);
  EXPECT_NEAR(curves.at(0.54)[1], 1, 1e-9);
  EXPECT_NEAR(curves.at(0.62)[2], 1, 1e-9);
}

TEST(VisemeCurves, RoundSoundsDominate) {
  const Script script = script_of({{"SIL", 0.3},
                                   {"IY", 0.2},
                                   {"W", 0.1},
                                   {"IY", 0.2},
                                   {"T", 0.06},
                                   {"AA", 0.2},
                                   {"OW", 0.3},
                                   {"SIL", 0.3}});
  const VisemeCurves curves(script);
  EXPECT_GT(curves.at(0.55)[14], 0.6);  // W
  const fap::VisemeWeights t = curves.at(0.83);
  EXPECT_GT(t[4], 0.2);  // T shows, and takes much of its neighbours
  EXPECT_LT(t[4], 0.6);
  EXPECT_GT(curves.at(1.08)[13], 0.6);  // OW begins as O
  EXPECT_GT(curves.at(1.28)[14], 0.6);  // and ends as U
}

TEST(VisemeCurves, HIsSaidWithTheNextSound) {
  const VisemeCurves curves(script_of({{"SIL", 0.3}, {"HH", 0.1}, {"UW", 0.2}, {"SIL", 0.2}}));
  EXPECT_GT(curves.at(0.35)[14], 0.99);
}

TEST(VisemeCurves, PausesAndNothingAreSilent) {
  const VisemeCurves curves(script_of({{"AA", 0.2}, {"SIL", 0.5}, {"AA", 0.2}}));
  EXPECT_GT(curves.at(0.1)[10], 0.99);
  EXPECT_EQ(curves.at(0.45)[0], 1);
  EXPECT_EQ(VisemeCurves({}).at(0.3)[0], 1);
  EXPECT_TRUE(viseme_weights({}, frames_of(1, {25, 1})).empty());
}

// Frames are on the clock of the clip, which begins somewhere on that of the script.
TEST(VisemeCurves, FramesHaveTimes) {
  const Script script = script_of({{"SIL", 1.0}, {"UW", 1.0}, {"SIL", 1.0}});
  fap::Sequence clip = frames_of(0.4, {10, 1});
  for (fap::Frame& frame : clip.frames) frame.number += 5;
  const auto weights = viseme_weights(script, clip, 0.7);
  ASSERT_EQ(weights.size(), 4u);
  EXPECT_GT(weights[0][14], 0.99);  // 1.2 s
  EXPECT_GT(weights[3][14], 0.99);
}

}  // namespace viseme_curves_test
}  // namespace animeme::dam
