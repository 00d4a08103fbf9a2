// Mouths that open wider.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fap/arkit.h"
#include "fap/wider.h"

namespace animeme::fap {
namespace wider_test {

Frame shown(std::string_view shape, double weight) {
  ArkitFrame weights{};
  weights[std::size_t(find_arkit(shape).value_or(0))] = weight;
  return arkit_to_fap(weights, kAllArkit);
}

int opening(const Frame& frame) { return -frame.value[4] - frame.value[5]; }

TEST(OpenWider, TheOpeningIsMultiplied) {
  const Frame frame = shown("jawOpen", 0.2);
  for (const double gain : {0.5, 1.0, 1.5, 3.0}) {
    EXPECT_NEAR(opening(open_wider(frame, gain)), gain * opening(frame), 3) << gain;
  }
  // It is the jaw that opens: chin and corners go along.
  const Frame wide = open_wider(frame, 2), jaw = shown("jawOpen", 0.4);
  for (const std::size_t fap : {3, 5, 12, 18, 52}) {
    EXPECT_NEAR(wide.value[fap], jaw.value[fap], 3) << fap;
  }
}

TEST(OpenWider, ShutLipsStayShut) {
  for (const auto& [shape, weight] : {std::pair{"mouthPressLeft", 0.7}, {"mouthSmileLeft", 0.0}}) {
    const Frame frame = shown(shape, weight);
    EXPECT_EQ(open_wider(frame, 3), frame) << shape;
  }
}

// F: the upper lip shows the teeth, the lower one is at them; V between vowels hardly opens.
TEST(OpenWider, LipsAtTheTeethStayThere) {
  Frame f;
  for (const auto& [fap, value] :
       {std::pair{3, 146}, {4, -87}, {5, -41}, {8, -75}, {9, -75}, {10, -18}, {11, -18}, {18, 0}}) {
    f.set(fap, value);
  }
  EXPECT_EQ(open_wider(f, 2.3), f);
  const Frame v = shown("jawOpen", 0.025);
  EXPECT_EQ(open_wider(v, 2.3), v);
  // No jump between these and open lips.
  int before = 0;
  for (int i = 0; i <= 100; ++i) {
    const int now = opening(open_wider(shown("jawOpen", i * 0.002), 3));
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 40);
    before = now;
  }
}

TEST(OpenWider, NothingOpensFurtherThanTheJaw) {
  const int full = opening(shown("jawOpen", 1));
  EXPECT_NEAR(opening(open_wider(shown("jawOpen", 0.6), 4)), full, 3);
  const Frame most = shown("jawOpen", 1);
  EXPECT_EQ(open_wider(most, 4), most);
}

TEST(OpenWider, WhatIsAbsentStaysAbsent) {
  Frame frame;
  frame.set(3, 300);
  frame.set(48, 1000);
  const Frame wide = open_wider(frame, 2);
  EXPECT_EQ(wide.mask, frame.mask);
  EXPECT_NEAR(wide.value[3], 600, 2);
  EXPECT_EQ(wide.value[48], 1000);
}

TEST(OpenWider, AnyNumbersAreSafe) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  for (const double gain : {std::nan(""), -1.0, 0.0, 1e300}) {
    for (const std::int32_t value : {kMost, -kMost, 0, 100}) {
      Frame frame;
      for (int fap = 3; fap <= 68; ++fap) frame.set(fap, value);
      EXPECT_EQ(open_wider(frame, gain).mask, frame.mask);
    }
  }
  EXPECT_EQ(open_wider(shown("jawOpen", 0.3), std::nan("")), shown("jawOpen", 0.3));
}

}  // namespace wider_test
}  // namespace animeme::fap
