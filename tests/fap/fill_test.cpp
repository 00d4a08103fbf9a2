#include "fap/fill.h"

#include <gtest/gtest.h>

#include "fap/tables.h"
#include "fap/text.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace {

using test::make_frame;

Sequence filled(const Sequence& clip, const FillOptions& options = {}) {
  Result<Sequence> result = fill(clip, options);
  EXPECT_TRUE(result) << (result ? "" : result.error().describe());
  return result ? *result : Sequence{};
}

Sequence clip_of(std::vector<Frame> frames) { return {{25, 1}, std::move(frames), "clip"}; }

TEST(Fill, HoldsTheLastValue) {
  const Sequence clip = clip_of({make_frame(0, {{3, 10}, {14, 5}}), make_frame(1, {{14, 6}}),
                                 make_frame(2, {{3, 0}, {15, 7}})});
  const Sequence f = filled(clip);
  ASSERT_EQ(f.frames.size(), 3u);
  EXPECT_EQ(f.frames[0], make_frame(0, {{3, 10}, {14, 5}, {15, 0}}));
  EXPECT_EQ(f.frames[1], make_frame(1, {{3, 10}, {14, 6}, {15, 0}}));
  EXPECT_EQ(f.frames[2], make_frame(2, {{3, 0}, {14, 6}, {15, 7}}));
  EXPECT_EQ(f.rate, clip.rate);
  EXPECT_EQ(f.name, clip.name);
}

TEST(Fill, MirrorsByMaskAndNotByValue) {
  // The right lid is sent and at rest: it stays at rest.
  const Sequence wink = clip_of({make_frame(0, {{19, 900}, {20, 0}})});
  EXPECT_EQ(filled(wink), wink);
  // The right lid is never sent: it follows.
  const Sequence left = clip_of({make_frame(0, {{19, 900}}), make_frame(1, {{19, 100}})});
  EXPECT_EQ(filled(left).frames[1], make_frame(1, {{19, 100}, {20, 100}}));
  EXPECT_EQ(filled(left, {.mirror = false}), left);
}

TEST(Fill, LipsFollowEachOther) {
  const Sequence inner = clip_of({make_frame(0, {{4, 1}, {8, 2}})});
  EXPECT_EQ(filled(inner).frames[0],
            make_frame(0, {{4, 1}, {8, 2}, {9, 2}, {51, 1}, {55, 2}, {56, 2}}));
  const Sequence outer = clip_of({make_frame(0, {{59, 3}})});
  EXPECT_EQ(filled(outer).frames[0], make_frame(0, {{12, 3}, {13, 3}, {59, 3}, {60, 3}}));
  EXPECT_EQ(filled(inner, {.lips = false}).frames[0], make_frame(0, {{4, 1}, {8, 2}, {9, 2}}));
  EXPECT_EQ(filled(inner, {.mirror = false}).frames[0],
            make_frame(0, {{4, 1}, {8, 2}, {51, 1}, {55, 2}}));
}

TEST(Fill, AllPairsOfTheTables) {
  for (const FapInfo& fap : kFaps) {
    if (fap.number < kFirstLowLevel) continue;
    const Frame frame = filled(clip_of({make_frame(0, {{fap.number, 42}})})).frames.at(0);
    Mask expected;
    expected.set(std::size_t(fap.number));
    if (fap.mirror) expected.set(std::size_t(fap.mirror));
    if (fap.partner) expected.set(std::size_t(fap.partner));
    if (fap.mirror && fap.partner) expected.set(std::size_t(info(fap.partner).mirror));
    EXPECT_EQ(frame.mask, expected) << fap.name;
    for (std::size_t n = kFirstLowLevel; n <= kFapCount; ++n) {
      EXPECT_EQ(frame.value[n], expected[n] ? 42 : 0) << fap.name;
    }
  }
}

TEST(Fill, AnOwnValueIsHeldUnlessThePartnerIsPreferred) {
  const Sequence clip = clip_of(
      {make_frame(0, {{31, 10}, {32, 20}}), make_frame(1, {{31, 30}}), make_frame(2, {{14, 1}})});
  const Sequence held = filled(clip);
  EXPECT_EQ(held.frames[1].value[32], 20);
  EXPECT_EQ(held.frames[2].value[32], 20);
  const Sequence mirrored = filled(clip, {.prefer_partner = true});
  EXPECT_EQ(mirrored.frames[0].value[32], 20);
  EXPECT_EQ(mirrored.frames[1].value[32], 30);
  EXPECT_EQ(mirrored.frames[2].value[32], 30);
  EXPECT_EQ(mirrored.frames[0].mask, held.frames[0].mask);
}

TEST(Fill, DerivedFapsStayWithAPreferredPartner) {
  const Sequence clip = clip_of({make_frame(0, {{3, 1}, {4, 9}}), make_frame(1, {{3, 2}})});
  const Sequence f = filled(clip, {.prefer_partner = true});
  EXPECT_EQ(f.frames[1], make_frame(1, {{3, 2}, {4, 9}, {51, 9}}));
}

TEST(Fill, SkippedFrames) {
  const Sequence clip = clip_of({make_frame(1, {{3, 10}}), make_frame(4, {{3, 40}})});
  const Sequence f = filled(clip);
  ASSERT_EQ(f.frames.size(), 5u);
  const std::int32_t held[] = {0, 10, 10, 10, 40};
  const Sequence smooth = filled(clip, {.interpolate = true});
  const std::int32_t between[] = {0, 10, 20, 30, 40};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(f.frames[i], make_frame(std::int64_t(i), {{3, held[i]}}));
    EXPECT_EQ(smooth.frames[i], make_frame(std::int64_t(i), {{3, between[i]}}));
  }
}

TEST(Fill, InterpolationOfExtremesStaysInRange) {
  const Sequence clip = clip_of({make_frame(0, {{3, INT32_MIN}}), make_frame(2, {{3, INT32_MAX}})});
  EXPECT_LE(std::abs(filled(clip, {.interpolate = true}).frames[1].value[3]), 1);
}

TEST(Fill, HighLevelFapsOnlyAlone) {
  Frame viseme;
  viseme.mask.set(1);
  viseme.viseme = {5, 6, 33, true};
  Frame both = make_frame(2, {{3, 10}});
  both.mask.set(2);
  both.expression = {1, 63, 0, 0, true, true};

  const Sequence alone = filled(clip_of({viseme, make_frame(2, {})}));
  ASSERT_EQ(alone.frames.size(), 3u);
  EXPECT_EQ(alone.frames[0].viseme, viseme.viseme);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(alone.frames[i].mask, viseme.mask);
    EXPECT_EQ(alone.frames[i].viseme, (Viseme{5, 6, 33, false}));
  }
  const Sequence mixed = filled(clip_of({viseme, both}));
  EXPECT_EQ(mixed.frames[2], make_frame(2, {{3, 10}}));
  EXPECT_EQ(mixed.frames[0], make_frame(0, {{3, 0}}));
  const Sequence kept = filled(clip_of({viseme, both}), {.keep_high_level = true});
  EXPECT_EQ(kept.frames[2].mask.count(), 3u);
  EXPECT_EQ(kept.frames[2].expression, both.expression);
  EXPECT_EQ(kept.frames[0].expression, Expression{});
}

TEST(Fill, ResultIsCompleteAndStable) {
  test::Random random(11);
  for (int round = 0; round < 50; ++round) {
    const Sequence clip = test::random_sequence(random, 10);
    for (const bool prefer : {false, true}) {
      const FillOptions options{.prefer_partner = prefer, .keep_high_level = true};
      const Sequence f = filled(clip, options);
      ASSERT_EQ(std::int64_t(f.frames.size()), clip.frames.back().number + 1);
      for (std::size_t i = 0; i < f.frames.size(); ++i) {
        ASSERT_EQ(f.frames[i].number, std::int64_t(i));
        ASSERT_EQ(f.frames[i].mask, f.frames[0].mask);
      }
      for (const Frame& frame : clip.frames) {
        const Frame& shown = f.frames[std::size_t(frame.number)];
        for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
          ASSERT_TRUE(!frame.mask[fap] || shown.value[fap] == frame.value[fap]);
        }
      }
      ASSERT_EQ(filled(f, options), f);
      ASSERT_TRUE(read_text(write_text(f)));
    }
  }
}

TEST(Fill, EmptyClip) { EXPECT_TRUE(filled(clip_of({})).frames.empty()); }

TEST(Fill, Errors) {
  const auto code = [](const Sequence& clip, const FillOptions& options = {}) {
    const Result<Sequence> result = fill(clip, options);
    EXPECT_FALSE(result);
    return result ? Code::internal : result.error().code;
  };
  EXPECT_EQ(code(clip_of({make_frame(-1, {})})), Code::invalid_argument);
  EXPECT_EQ(code(clip_of({make_frame(1, {}), make_frame(1, {})})), Code::invalid_argument);
  EXPECT_EQ(code(clip_of({make_frame(2'000'000'000'000, {})})), Code::out_of_range);
  EXPECT_EQ(code(clip_of({make_frame(10, {})}), {.max_frames = 10}), Code::out_of_range);
  EXPECT_EQ(filled(clip_of({make_frame(9, {})}), {.max_frames = 10}).frames.size(), 10u);
}

}  // namespace
}  // namespace animeme::fap
