#include "fap/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fap/make.h"

namespace animeme::fap {
namespace compare_test {

using made::make_frame;

Sequence clip_of(std::vector<Frame> frames, Rate rate = {25, 1}) {
  return {rate, std::move(frames), ""};
}

TEST(Compare, EqualClips) {
  made::Random random(3);
  const Sequence clip = made::random_sequence(random, 20);
  Sequence renamed = clip;
  renamed.name = "other";
  const Difference d = compare(clip, renamed);
  EXPECT_TRUE(d.equal());
  EXPECT_EQ(d.frames_both, 20);
  EXPECT_EQ(d.max_fap, 0);
  EXPECT_EQ(d.rms_steps, 0);
  for (int fap = 1; fap <= kFapCount; ++fap) {
    std::int64_t present = 0;
    for (const Frame& frame : clip.frames) present += frame.mask[std::size_t(fap)];
    EXPECT_EQ(d.fap[std::size_t(fap)].frames, present);
  }
  EXPECT_TRUE(compare({}, {}).equal());
}

TEST(Compare, RootMeanSquareAndSteps) {
  // FAP 3 has steps of 4, FAP 48 of 170.
  const Sequence a =
      clip_of({make_frame(0, {{3, 10}, {48, 0}}), make_frame(1, {{3, 20}, {48, 0}})});
  const Sequence b =
      clip_of({make_frame(0, {{3, 16}, {48, 0}}), make_frame(1, {{3, 12}, {48, -340}})});
  const Difference d = compare(a, b);
  EXPECT_FALSE(d.equal());
  EXPECT_EQ(d.first_difference, 0);
  EXPECT_EQ(d.value_differences, 3);
  EXPECT_EQ(d.mask_differences, 0);
  EXPECT_DOUBLE_EQ(d.fap[3].rms, std::sqrt(50.0));
  EXPECT_EQ(d.fap[3].max, 8);
  EXPECT_EQ(d.fap[3].max_frame, 1);
  EXPECT_DOUBLE_EQ(d.fap[3].rms_steps, std::sqrt(50.0) / 4);
  EXPECT_DOUBLE_EQ(d.fap[3].max_steps, 2);
  EXPECT_EQ(d.fap[48].differing, 1);
  EXPECT_DOUBLE_EQ(d.fap[48].rms_steps, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(d.rms_steps, std::sqrt((2.25 + 4 + 0 + 4) / 4));
  EXPECT_DOUBLE_EQ(d.max_steps, 2);
  EXPECT_EQ(d.max_fap, 3);
}

TEST(Compare, AbsentIsNotZero) {
  const Sequence a = clip_of({make_frame(0, {{3, 0}, {4, 1}})});
  const Sequence b = clip_of({make_frame(0, {{4, 1}, {5, 0}})});
  const Difference d = compare(a, b);
  EXPECT_EQ(d.mask_differences, 2);
  EXPECT_EQ(d.fap[3].only_a, 1);
  EXPECT_EQ(d.fap[5].only_b, 1);
  EXPECT_EQ(d.fap[4].frames, 1);
  EXPECT_EQ(d.value_differences, 0);
  EXPECT_EQ(d.first_difference, 0);
}

TEST(Compare, FramesOfOneClipOnly) {
  const Sequence a = clip_of({make_frame(0, {{3, 1}}), make_frame(2, {{3, 1}})});
  const Sequence b = clip_of({make_frame(0, {{3, 1}}), make_frame(1, {{3, 9}}),
                              make_frame(2, {{3, 1}}), make_frame(7, {{3, 1}})});
  const Difference d = compare(a, b);
  EXPECT_EQ(d.frames_a, 2);
  EXPECT_EQ(d.frames_b, 4);
  EXPECT_EQ(d.frames_both, 2);
  EXPECT_EQ(d.value_differences, 0);
  EXPECT_EQ(d.first_difference, 1);
  EXPECT_EQ(compare(b, a).first_difference, 1);
  EXPECT_EQ(compare(b, {}).first_difference, 0);
}

TEST(Compare, RatesAndHighLevelFaps) {
  EXPECT_FALSE(compare(clip_of({}), clip_of({}, {30, 1})).equal());
  Frame a = make_frame(0, {});
  a.mask.set(1);
  a.mask.set(2);
  Frame b = a;
  b.viseme.select1 = 3;
  const Difference d = compare(clip_of({a}), clip_of({b}));
  EXPECT_EQ(d.fap[1].differing, 1);
  EXPECT_EQ(d.fap[2].differing, 0);
  EXPECT_EQ(d.value_differences, 1);
  EXPECT_EQ(d.max_steps, 0);
  EXPECT_FALSE(d.equal());
}

TEST(Compare, ExtremeValues) {
  const Sequence a = clip_of({make_frame(0, {{3, INT32_MIN}})});
  const Sequence b = clip_of({make_frame(0, {{3, INT32_MAX}})});
  EXPECT_EQ(compare(a, b).fap[3].max, 4294967295);
}

// Values of absent FAPs and of unused flags are not content.
TEST(Compare, IgnoresValuesOfAbsentFaps) {
  const Sequence a = clip_of({make_frame(0, {{3, 5}})});
  Sequence b = a;
  b.frames[0].value[40] = 99;
  b.frames[0].viseme.select1 = 4;
  EXPECT_TRUE(compare(a, b).equal());
}

}  // namespace compare_test
}  // namespace animeme::fap
