// Weights of any shapes for a face.
#include "fap/shape_fit.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

#include "tests/fap/make.h"

namespace animeme::fap {
namespace shape_fit_test {

Frame frame_of(std::initializer_list<std::pair<int, int>> values) {
  Frame frame;
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) frame.set(fap, 0);
  for (const auto& [fap, value] : values) frame.set(fap, value);
  return frame;
}

// A jaw that takes the lower lip along, and lips that close over an open jaw.
const std::vector<Frame> kMouth = {
    frame_of({{3, 600}, {5, -500}, {10, -400}, {11, -400}}),
    frame_of({{4, 200}, {5, 300}, {8, 150}, {9, 150}, {10, 250}, {11, 250}}),
    frame_of({{19, 1024}})};
// As measured, the second shape does half of what its FAPs say.
const LipMeasures kLips = {{}, {{-500, -400, -400}, {250, 200, 200}, {}}};

double closing(const std::vector<double>& weights, std::size_t pair) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * kLips.closing[i][pair];
  return sum;
}

TEST(ShapeFitter, FindsTheWeightsThatMadeAFace) {
  ShapeFitter fitter(kMouth);
  const auto weights =
      fitter.fit(frame_of({{3, 300}, {5, -250}, {10, -200}, {11, -200}, {19, 768}}));
  EXPECT_NEAR(weights[0], 0.5, 0.01);
  EXPECT_NEAR(weights[1], 0, 0.01);
  EXPECT_NEAR(weights[2], 0.75, 0.01);
}

TEST(ShapeFitter, FramesDoNotDependOnEachOther) {
  ShapeFitter fitter(kMouth, kLips);
  const Frame open = frame_of({{3, 300}, {5, -250}}), shut = frame_of({{3, 200}});
  const auto alone = fitter.fit(open);
  fitter.fit(shut);
  EXPECT_EQ(fitter.fit(open), alone);
  EXPECT_EQ(fitter.fit(frame_of({})), (std::vector<double>{0, 0, 0}));
}

// A jaw that hangs behind shut lips.
TEST(ShapeFitter, ShutLipsMeetAsTheyWereMeasured) {
  const Frame shut = frame_of({{3, 300}});
  ShapeFitter rough(kMouth), measured(kMouth, kLips);
  const auto by_faps = rough.fit(shut), by_measure = measured.fit(shut);
  for (std::size_t pair = 0; pair < 3; ++pair) {
    EXPECT_LT(closing(by_faps, pair), -40) << "the example shows nothing";
    EXPECT_NEAR(closing(by_measure, pair), 0, 15);
  }
}

TEST(ShapeFitter, OpenLipsAreLeftToTheFaps) {
  const Frame open = frame_of({{3, 300}, {5, -250}, {10, -200}, {11, -200}});
  ShapeFitter rough(kMouth), measured(kMouth, kLips);
  EXPECT_EQ(rough.fit(open), measured.fit(open));
}

// From open to shut nothing jumps.
TEST(ShapeFitter, WeightsChangeSteadily) {
  ShapeFitter fitter(kMouth, kLips);
  std::vector<double> before;
  for (int lip = -200; lip <= 40; ++lip) {
    const auto weights = fitter.fit(frame_of({{3, 250}, {5, lip}, {10, lip}, {11, lip}}));
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_NEAR(weights[i], before[i], 0.02) << "shape " << i << " at " << lip;
    }
    before = weights;
  }
}

// A shape whose FAPs are not known is not used, even if it would close the lips.
TEST(ShapeFitter, WhatSaysNothingIsNotUsed) {
  std::vector<Frame> shapes = kMouth;
  shapes.push_back(frame_of({}));
  LipMeasures lips = kLips;
  lips.closing.push_back({300, 300, 300});
  ShapeFitter measured(kMouth, kLips), more(shapes, lips);
  const Frame shut = frame_of({{3, 300}});
  auto without = measured.fit(shut);
  without.push_back(0);
  EXPECT_EQ(more.fit(shut), without);
}

// Shapes that were added after the lips were measured count as shapes that leave them alone.
TEST(ShapeFitter, ShapesWithoutADistanceLeaveTheLipsAlone) {
  LipMeasures shorter = kLips, padded = kLips;
  shorter.closing.resize(1);
  padded.closing.assign({kLips.closing[0], {}, {}});
  ShapeFitter some(kMouth, shorter), all(kMouth, padded), measured(kMouth, kLips);
  const Frame shut = frame_of({{3, 300}});
  EXPECT_EQ(some.fit(shut), all.fit(shut));
  EXPECT_NE(some.fit(shut), measured.fit(shut));
}

// Lips that are apart in the neutral face meet where a frame presses them; those that meet anyway
// are left alone.
TEST(ShapeFitter, PressedLipsMeetIfTheyDoNotYet) {
  const Frame pressed = frame_of({{4, 20}, {5, 20}, {8, 20}, {9, 20}, {10, 20}, {11, 20}});
  LipMeasures apart = kLips;
  apart.at_rest = {40, 40, 40};
  ShapeFitter rough(kMouth), together(kMouth, kLips), ajar(kMouth, apart);
  const auto by_faps = rough.fit(pressed), some = ajar.fit(pressed);
  EXPECT_EQ(together.fit(pressed), by_faps);
  for (std::size_t pair = 0; pair < 3; ++pair) {
    EXPECT_GT(closing(by_faps, pair), 0);
    EXPECT_GT(closing(some, pair), closing(by_faps, pair) + 8);
    EXPECT_LT(closing(some, pair), 45);
  }
}

// What stands behind the mask of a shape is not part of it, whatever its value.
TEST(ShapeFitter, ShapesAreWhatTheirMaskHas) {
  std::vector<Frame> plain = {made::make_frame(0, {{3, 600}, {5, -500}}),
                              made::make_frame(0, {{19, 1024}})};
  std::vector<Frame> stale = plain;
  stale[0].value[19] = 1024;
  stale[1].value[3] = -600;
  stale[1].value[5] = 500;
  ShapeFitter by_mask(plain), with_rest(stale);
  const Frame face = frame_of({{3, 300}, {5, -250}, {19, 512}});
  EXPECT_EQ(by_mask.fit(face), with_rest.fit(face));
  EXPECT_NEAR(by_mask.fit(face)[0], 0.5, 0.01);
  EXPECT_NEAR(by_mask.fit(face)[1], 0.5, 0.01);
}

}  // namespace shape_fit_test
}  // namespace animeme::fap
