// Turns between the steps of a quantiser: they move, and stay within half a step of what is coded.
#include "fap/turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace animeme::fap {
namespace turns_test {

constexpr int kStep = 170;  // FAP 48 to 50 at quantiser 1
constexpr int kYaw = 49;

using Motion = std::function<double(double seconds)>;  // 1e-5 rad

Sequence coded(const Motion& motion, double rate, double seconds, int step = kStep) {
  Sequence clip;
  clip.rate = {std::uint32_t(rate), 1};
  for (int i = 0; i < int(rate * seconds); ++i) {
    Frame frame;
    frame.number = i;
    frame.set(kYaw, step * int(std::lround(motion(i / rate) / step)));
    clip.frames.push_back(frame);
  }
  return clip;
}

Sequence streamed(const Sequence& clip) {
  Sequence out = clip;
  TurnSmoother turns;
  for (Frame& frame : out.frames) frame = turns.next(frame);
  return out;
}

Sequence smoothed(Sequence clip) {
  smooth_turns(clip);
  return clip;
}

double value(const Sequence& clip, std::size_t i) { return clip.frames[i].value[kYaw]; }

double still_share(const Sequence& clip) {
  int still = 0;
  for (std::size_t i = 1; i < clip.frames.size(); ++i)
    still += value(clip, i) == value(clip, i - 1);
  return still / double(clip.frames.size() - 1);
}

// Of the acceleration that is not of the motion, a frame and frame.
double roughness(const Sequence& clip, const Motion& motion) {
  const double rate = clip.rate.frames_per_second();
  const auto off = [&](std::size_t i) { return value(clip, i) - motion(double(i) / rate); };
  double sum = 0;
  for (std::size_t i = 1; i + 1 < clip.frames.size(); ++i) {
    sum += std::pow(off(i - 1) - 2 * off(i) + off(i + 1), 2);
  }
  return std::sqrt(sum / double(clip.frames.size() - 2));
}

double farthest(const Sequence& a, const Sequence& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    most = std::max(most, std::abs(value(a, i) - value(b, i)));
  }
  return most;
}

TEST(Turns, ASlowTurnMovesInEveryFrame) {
  const Motion motion = [](double t) { return 1000 * t; };  // 0.6 degrees a second
  const Sequence clip = coded(motion, 60, 10);
  ASSERT_GT(still_share(clip), 0.85);
  EXPECT_LT(still_share(smoothed(clip)), 0.02);
  EXPECT_LT(still_share(streamed(clip)), 0.05);
  EXPECT_LT(roughness(smoothed(clip), motion), 0.1 * roughness(clip, motion));
  EXPECT_LT(roughness(streamed(clip), motion), 0.4 * roughness(clip, motion));
}

TEST(Turns, ASwayingHeadDoesNotTick) {
  const Motion motion = [](double t) { return 3500 * std::sin(t) + 500 * std::sin(3.1 * t); };
  for (const double rate : {25.0, 30.0, 60.0}) {
    const Sequence clip = coded(motion, rate, 10);
    EXPECT_LT(roughness(smoothed(clip), motion), 0.2 * roughness(clip, motion)) << rate;
    EXPECT_LT(roughness(streamed(clip), motion), 0.5 * roughness(clip, motion)) << rate;
  }
}

// Half a step is what the coder left open, and there is no delay beyond it, whatever moves.
TEST(Turns, StayWithinHalfAStep) {
  std::mt19937 random(5);
  for (const int step : {kStep, 2 * kStep, 4 * kStep, 128}) {
    double at = 0;
    std::vector<double> walk;
    for (int i = 0; i < 600; ++i) {
      at += (int(random() % 2001) - 1000) * (random() % 7 == 0 ? 5 : 0.3);
      walk.push_back(at);
    }
    const Sequence clip =
        coded([&](double t) { return walk[std::size_t(std::lround(t * 60))]; }, 60, 10, step);
    EXPECT_LE(farthest(smoothed(clip), clip), step / 2 + 1) << step;
    // A stream takes several steps for one until it has seen one alone.
    Sequence settled = clip;
    for (const std::size_t i : {0u, 1u, 2u, 3u}) settled.frames[i].value[kYaw] = i % 2 * step;
    EXPECT_LE(farthest(streamed(settled), settled), step / 2 + 1) << step;
  }
}

TEST(Turns, AStillHeadStaysStill) {
  Sequence clip = coded([](double) { return 680; }, 60, 2);
  const Sequence before = clip;
  EXPECT_TRUE(streamed(clip).frames == before.frames);
  smooth_turns(clip);
  EXPECT_TRUE(clip.frames == before.frames);
}

TEST(Turns, FineAndCoarseValuesAndOtherFapsStayAsTheyAre) {
  const Motion motion = [](double t) { return 3500 * std::sin(t); };
  for (const int step : {1, 50, 4000}) {
    const Sequence clip = coded(motion, 30, 5, step);
    EXPECT_TRUE(smoothed(clip).frames == clip.frames) << step;
    EXPECT_TRUE(streamed(clip).frames == clip.frames) << step;
  }
  Sequence lips = coded(motion, 30, 5);
  for (Frame& frame : lips.frames) {
    frame.set(5, frame.value[kYaw]);
    frame.mask.reset(kYaw);
    frame.value[kYaw] = 0;
  }
  EXPECT_TRUE(smoothed(lips).frames == lips.frames);
  EXPECT_TRUE(streamed(lips).frames == lips.frames);
}

TEST(Turns, NoFramesAndOne) {
  Sequence none;
  smooth_turns(none);
  EXPECT_TRUE(none.frames.empty());
  Sequence one = coded([](double) { return 340; }, 25, 0.04);
  const Sequence before = one;
  smooth_turns(one);
  EXPECT_TRUE(one.frames == before.frames);
}

}  // namespace turns_test
}  // namespace animeme::fap
