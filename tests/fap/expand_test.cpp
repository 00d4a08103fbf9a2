// FAP 1 and 2 as low-level FAPs: frame by frame, defined by streams, and by fill().
#include "fap/expand.h"

#include <gtest/gtest.h>

#include "fap/fill.h"
#include "fap/receiver.h"
#include "fap/tables.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace expand_test {

Frame viseme(std::int64_t number, int first, int second, int blend, bool def = false) {
  Frame frame;
  frame.number = number;
  frame.mask.set(1);
  frame.viseme = {first, second, blend, def};
  return frame;
}

Frame expression(std::int64_t number, int select, int intensity, bool def = false) {
  Frame frame;
  frame.number = number;
  frame.mask.set(2);
  frame.expression = {select, intensity, 0, 0, false, def};
  return frame;
}

TEST(Expand, FillShowsVisemesAsLowLevelFaps) {
  const Sequence clip{{25, 1}, {viseme(0, 10, 0, 63), viseme(2, 1, 10, 21)}, "x"};
  const auto filled = fill(clip, {.expand = true});
  ASSERT_TRUE(filled);
  ASSERT_EQ(filled->frames.size(), 3u);
  EXPECT_FALSE(filled->frames[0].mask[1]);
  EXPECT_EQ(filled->frames[0].value[3], viseme_pose(10).value[3]);
  EXPECT_EQ(filled->frames[1].value, filled->frames[0].value);  // held
  EXPECT_EQ(filled->frames[2].value, low_level(clip.frames[1]).value);
  for (const Frame& frame : filled->frames) {
    EXPECT_EQ(frame.mask, filled->frames[0].mask);
    for (const FapInfo& fap : kFaps) {
      if (fap.mirror == 0) continue;
      EXPECT_EQ(frame.mask[std::size_t(fap.number)], frame.mask[std::size_t(fap.mirror)]);
    }
  }
}

// Head and brows of a stream do not hide its visemes, nor does asking for every FAP.
TEST(Expand, OtherFapsAndCompleteLeaveTheVisemes) {
  Frame frame = viseme(0, 10, 0, 63);
  frame.set(48, 900);
  frame.set(3, 5);
  const auto filled = fill({{25, 1}, {frame}, "x"}, {.expand = true, .complete = true});
  ASSERT_TRUE(filled);
  const Frame& shown = filled->frames[0];
  EXPECT_EQ(shown.mask.count(), 66u);
  EXPECT_EQ(shown.value[48], 900);
  EXPECT_EQ(shown.value[3], 5);  // its own wins
  EXPECT_EQ(shown.value[5], viseme_pose(10).value[5]);
}

TEST(Expand, AVisemeIsDefinedByItsFrame) {
  Frame definition = viseme(0, 10, 0, 63, true);
  definition.set(3, 1000);
  definition.set(4, -100);
  definition.set(48, 70);  // no part of a mouth
  const Sequence clip{{25, 1}, {definition, viseme(1, 10, 0, 21), viseme(2, 11, 0, 63)}, "x"};
  const auto filled = fill(clip, {.expand = true});
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->frames[0].value[3], 1000);
  EXPECT_EQ(filled->frames[0].value[5], 0);
  EXPECT_EQ(filled->frames[1].value[3], 333);
  EXPECT_EQ(filled->frames[1].value[4], -33);
  EXPECT_EQ(filled->frames[1].value[48], 70);
  EXPECT_EQ(filled->frames[2].value[3], viseme_pose(11).value[3]);  // the others are as ever
}

TEST(Expand, DefinitionsWithTwoShapesArePassedOver) {
  Frame definition = viseme(0, 10, 11, 30, true);
  definition.set(3, 1000);
  const auto filled = fill({{25, 1}, {definition, viseme(1, 10, 0, 63)}, "x"}, {.expand = true});
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->frames[1].value[3], viseme_pose(10).value[3]);
}

TEST(Expand, AnExpressionIsDefinedAtItsIntensity) {
  Frame definition = expression(0, 1, 21, true);
  definition.set(12, 100);
  definition.set(13, 100);
  const auto filled = fill({{25, 1}, {definition, expression(1, 1, 63)}, "x"}, {.expand = true});
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->frames[0].value[12], 100);
  EXPECT_EQ(filled->frames[1].value[12], 300);
  EXPECT_EQ(filled->frames[1].value[31], 0);  // no brows: they are not in the definition
}

TEST(Expand, NothingToExpandChangesNothing) {
  made::Random random(7);
  for (int round = 0; round < 50; ++round) {
    Sequence clip = made::random_sequence(random, 12);
    for (Frame& frame : clip.frames) frame = with_mask(frame, frame.mask & ~Mask(6));
    const auto plain = fill(clip), expanded = fill(clip, {.expand = true});
    ASSERT_TRUE(plain && expanded);
    EXPECT_EQ(plain->frames, expanded->frames);
  }
}

TEST(Expand, WildValuesStayInRange) {
  Frame frame = viseme(0, 2000000000, -7, -2000000000);
  frame.mask.set(2);
  frame.expression = {1, 2000000000, 6, -2000000000, true, true};
  frame.set(3, 2000000000);
  const auto filled = fill({{25, 1}, {frame, expression(1, 1, 63)}, "x"}, {.expand = true});
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->frames.size(), 2u);
}

}  // namespace expand_test
}  // namespace animeme::fap
