#include "fap/edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fap/fill.h"
#include "fap/tables.h"
#include "tests/support/random_clip.h"

namespace animeme::fap {
namespace edit_test {

using testing::Each;
using testing::ElementsAre;

// A clip of one FAP.
Sequence clip_of(int fap, std::vector<std::int32_t> values) {
  Sequence clip;
  clip.rate = {10, 1};
  for (const std::int32_t value : values) {
    Frame frame;
    frame.number = std::int64_t(clip.frames.size());
    frame.set(fap, value);
    clip.frames.push_back(frame);
  }
  return clip;
}

std::vector<std::int32_t> values(const Sequence& clip, int fap) {
  std::vector<std::int32_t> all;
  for (const Frame& frame : clip.frames) all.push_back(frame.value[std::size_t(fap)]);
  return all;
}

TEST(Regions, HaveEachFapOnce) {
  Mask all;
  std::size_t count = 0;
  for (const Region& region : regions()) {
    all |= region.faps;
    count += region.faps.count();
    EXPECT_EQ(region_faps(region.name), region.faps);
  }
  EXPECT_EQ(count, std::size_t(kFapCount));
  EXPECT_EQ(all.count(), std::size_t(kFapCount));
  EXPECT_FALSE(all[0]);
  EXPECT_EQ(region_faps("nothing"), std::nullopt);
  EXPECT_TRUE(region_faps("head")->test(49));
}

TEST(Edit, ScalesWhatIsNamed) {
  Sequence clip = clip_of(3, {10, -11, 0});
  scale(clip, *region_faps("lips"), 2);
  EXPECT_THAT(values(clip, 3), ElementsAre(10, -11, 0));
  scale(clip, *region_faps("jaw"), 1.5);
  EXPECT_THAT(values(clip, 3), ElementsAre(15, -17, 0));
}

TEST(Edit, SmoothsWithoutDelayAndKeepsSums) {
  Sequence clip = clip_of(48, std::vector<std::int32_t>(41, 0));
  clip.frames[20].value[48] = 10000;
  smooth(clip, *region_faps("head"), 0.4);
  const auto smoothed = values(clip, 48);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < smoothed.size(); ++i) {
    EXPECT_EQ(smoothed[i], smoothed[40 - i]) << i;
    EXPECT_LE(smoothed[i], smoothed[20]);
    sum += smoothed[i];
  }
  EXPECT_NEAR(double(sum), 10000, 20);
  EXPECT_NEAR(smoothed[20], 10000 / (2 * std::sqrt(2 * M_PI)), 30);  // deviation: two frames
  Sequence still = clip_of(48, std::vector<std::int32_t>(5, 77));
  smooth(still, *region_faps("head"), 3);
  EXPECT_THAT(values(still, 48), Each(77));
}

TEST(Edit, MirrorsSidesAndDirections) {
  Sequence clip = clip_of(49, {100});  // the head turns left
  Frame& frame = clip.frames.front();
  frame.set(6, 20);   // left corner, outwards
  frame.set(23, 50);  // the left eye looks left
  frame.set(24, 40);
  frame.set(15, 7);  // jaw to the right
  frame.set(48, 9);
  frame.set(67, 3);  // left ear, outwards
  mirror(clip);
  EXPECT_EQ(frame.value[49], -100);
  EXPECT_EQ(frame.value[7], 20);
  EXPECT_EQ(frame.value[6], 0);
  EXPECT_FALSE(frame.mask[6]);
  EXPECT_TRUE(frame.mask[7]);
  EXPECT_EQ(frame.value[23], -40);
  EXPECT_EQ(frame.value[24], -50);
  EXPECT_EQ(frame.value[15], -7);
  EXPECT_EQ(frame.value[48], 9);
  EXPECT_EQ(frame.value[68], 3);
}

TEST(Edit, MirroringTwiceIsNothing) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Sequence clip = test::random_clip(seed, 20);
    Sequence twice = clip;
    mirror(twice);
    mirror(twice);
    EXPECT_EQ(twice, clip);
  }
}

TEST(Edit, FadesFromRestAndToRest) {
  Sequence clip = clip_of(3, std::vector<std::int32_t>(21, 1000));
  for (Frame& frame : clip.frames) {
    frame.mask.set(2);
    frame.expression = {1, 60, 0, 0, false, false};
  }
  fade(clip, 0.4, 0.8);
  EXPECT_THAT(values(clip, 3), ElementsAre(0, 146, 500, 854, 1000, 1000, 1000, 1000, 1000, 1000,
                                           1000, 1000, 1000, 962, 854, 691, 500, 309, 146, 38, 0));
  EXPECT_EQ(clip.frames[0].expression.intensity1, 0);
  EXPECT_EQ(clip.frames[2].expression.intensity1, 30);
  EXPECT_EQ(clip.frames[8].expression.intensity1, 60);
}

// What long clips are edited by: pieces with as many neighbours as smoothing wants.
TEST(Edit, PiecesAreThoseOfTheWhole) {
  const Sequence clip = *fill(test::random_clip(3, 200));
  const Sequence other = *fill(test::random_clip(4, 120));
  const Mask lips = *region_faps("lips");
  const Mask all = Mask().set().reset(0);
  Sequence whole = clip;
  replace(whole, other, lips, 1.5);
  smooth(whole, all, 0.3);
  fade(whole, 1, 4);
  const auto reach = std::int64_t(smooth_reach(clip.rate, 0.3));
  EXPECT_GE(reach, 4);
  const auto count = std::int64_t(clip.frames.size()), step = std::int64_t(37);
  for (std::int64_t first = 0; first < count; first += step) {
    const std::int64_t from = std::max<std::int64_t>(first - reach, 0);
    const std::int64_t to = std::min(first + step + reach, count);
    const auto slice = [&](const Sequence& from_clip) {
      Sequence piece{clip.rate, {}, {}};
      for (std::int64_t i = from; i < std::min(to, std::int64_t(from_clip.frames.size())); ++i) {
        piece.frames.push_back(from_clip.frames[std::size_t(i)]);
      }
      return piece;
    };
    Sequence piece = slice(clip);
    replace(piece, slice(other), lips, 1.5, {from, count}, std::int64_t(other.frames.size()));
    smooth(piece, all, 0.3);
    fade(piece, 1, 4, {from, count});
    for (std::int64_t i = first; i < std::min(first + step, count); ++i) {
      EXPECT_EQ(piece.frames[std::size_t(i - from)].value, whole.frames[std::size_t(i)].value) << i;
    }
  }
}

TEST(Edit, TakesFapsFromAnotherClip) {
  Sequence clip = clip_of(31, {1, 2, 3, 4});
  Sequence lips = clip_of(5, {100, 200});
  for (Frame& frame : lips.frames) frame.set(31, 900);
  replace(clip, lips, *region_faps("lips"), 0);
  EXPECT_THAT(values(clip, 5), ElementsAre(100, 200, 0, 0));
  EXPECT_THAT(values(clip, 31), ElementsAre(1, 2, 3, 4));
  EXPECT_TRUE(clip.frames[3].mask[5]);
}

TEST(Edit, ReturnsWhereTheOtherClipEnds) {
  Sequence clip = clip_of(5, std::vector<std::int32_t>(10, 0));
  replace(clip, clip_of(5, {100, 100, 100, 100, 100, 100}), *region_faps("lips"), 0.4);
  EXPECT_THAT(values(clip, 5), ElementsAre(100, 100, 100, 85, 50, 15, 0, 0, 0, 0));
}

TEST(Edit, AppendsAndRestsWhatIsMissing) {
  Sequence clip = clip_of(3, {10, 20});
  append(clip, clip_of(31, {5, 6, 7}), 0);
  EXPECT_THAT(values(clip, 3), ElementsAre(10, 20, 0, 0, 0));
  EXPECT_THAT(values(clip, 31), ElementsAre(0, 0, 5, 6, 7));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(clip.frames[i].number, std::int64_t(i));
    EXPECT_TRUE(clip.frames[i].mask[3] && clip.frames[i].mask[31]);
  }
}

TEST(Edit, CrossFadesFromTheLastPose) {
  Sequence clip = clip_of(3, {0, 100});
  append(clip, clip_of(3, {0, 0, 0, 0, 0}), 0.3);
  EXPECT_THAT(values(clip, 3), ElementsAre(0, 100, 85, 50, 15, 0, 0));
}

}  // namespace edit_test
}  // namespace animeme::fap
