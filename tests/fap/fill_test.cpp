#include "fap/fill.h"
#include "fap/expand.h"

#include <gtest/gtest.h>

#include "fap/tables.h"
#include "fap/text.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace fill_test {

using made::make_frame;

Sequence filled(const Sequence& clip, const FillOptions& options = {}) {
  Result<Sequence> result = fill(clip, options);
  EXPECT_TRUE(result) << (result ? "" : result.error().describe());
  return result ? *result : Sequence{};
}

Sequence clip_of(std::vector<Frame> frames) { return {{25, 1}, std::move(frames), "clip"}; }

TEST(Fill, CompleteGivesEveryLowLevelFapAValue) {
  Sequence clip;
  clip.frames.resize(1);
  clip.frames[0].set(3, 40);
  clip.frames[0].mask.set(1);
  const auto partly = fill(clip);
  const auto complete = fill(clip, {.complete = true});
  ASSERT_TRUE(partly && complete);
  EXPECT_EQ(partly->frames[0].mask, Mask().set(3));
  EXPECT_EQ(complete->frames[0].mask.count(), 66U);
  EXPECT_EQ(complete->frames[0].value, partly->frames[0].value);
  EXPECT_FALSE(complete->frames[0].mask[1]);
  EXPECT_TRUE(fill(clip, {.keep_high_level = true, .complete = true})->frames[0].mask[1]);
  // A stream of visemes stays one.
  clip.frames[0].mask = Mask().set(1);
  EXPECT_EQ(fill(clip, {.complete = true})->frames[0].mask, Mask().set(1));
  // One that codes nothing shows a face at rest.
  clip.frames[0].mask.reset();
  EXPECT_EQ(fill(clip, {.complete = true})->frames[0].mask.count(), 66U);
}

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

TEST(Fill, ExpressionsMayStayForHeadsWithTheirOwn) {
  Frame first = make_frame(0, {{3, 10}});
  first.mask.set(1).set(2);
  first.viseme = {5, 0, 63, false};
  first.expression = {1, 63, 0, 0, false, false};
  const Frame second = make_frame(2, {{3, 20}});
  const Sequence shown =
      filled(clip_of({first, second}), {.expand = true, .keep_expressions = true});
  const Sequence all = filled(clip_of({first, second}), {.expand = true});
  ASSERT_EQ(shown.frames.size(), 3u);
  for (const Frame& frame : shown.frames) {
    EXPECT_FALSE(frame.mask[1]);
    EXPECT_TRUE(frame.mask[2]);
    EXPECT_EQ(frame.expression, first.expression);
    EXPECT_FALSE(frame.mask[31]);
  }
  EXPECT_EQ(shown.frames[2].value[3], 20);
  EXPECT_EQ(shown.frames[0].value[5], viseme_pose(5).value[5]);
  EXPECT_TRUE(all.frames[0].mask[31]);
  EXPECT_FALSE(all.frames[0].mask[2]);
}

TEST(Fill, ResultIsCompleteAndStable) {
  made::Random random(11);
  for (int round = 0; round < 50; ++round) {
    const Sequence clip = made::random_sequence(random, 10);
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

GroupRules all(GroupRule rule) {
  GroupRules rules;
  rules.fill(rule);
  return rules;
}

// All frames under the same rules.
Sequence ruled(const Sequence& clip, const GroupRules& rules, const FillOptions& options = {}) {
  Result<Sequence> result = fill(clip, std::vector<GroupRules>(clip.frames.size(), rules), options);
  EXPECT_TRUE(result) << (result ? "" : result.error().describe());
  return result ? *result : Sequence{};
}

TEST(FillByRule, InterpolatedFapsFollowWhateverTheyHadBefore) {
  const Sequence clip = clip_of({make_frame(0, {{6, 1}, {7, 2}}), make_frame(1, {{6, 30}})});
  EXPECT_EQ(ruled(clip, all(GroupRule::interpolate)).frames[1],
            make_frame(1, {{6, 30}, {7, 30}, {53, 30}, {54, 30}}));
  EXPECT_EQ(ruled(clip, all(GroupRule::hold)).frames[1], make_frame(1, {{6, 30}, {7, 2}}));
}

TEST(FillByRule, HoldDoesNotFollowEvenIfNeverSent) {
  const Sequence clip = clip_of({make_frame(0, {{19, 900}})});
  EXPECT_EQ(ruled(clip, all(GroupRule::hold)), clip);
}

TEST(FillByRule, TheGroupOfTheFollowerDecides) {
  GroupRules rules = all(GroupRule::hold);
  rules[1] = GroupRule::interpolate;  // jaw and inner lip follow, the outer lip does not
  const Sequence inner = clip_of({make_frame(0, {{12, 5}})});
  EXPECT_EQ(ruled(inner, rules).frames[0], make_frame(0, {{12, 5}, {13, 5}}));
  const Sequence outer = clip_of({make_frame(0, {{59, 6}})});
  EXPECT_EQ(ruled(outer, rules).frames[0], make_frame(0, {{12, 6}, {13, 6}, {59, 6}}));
}

TEST(FillByRule, SideThenContourThenAcross) {
  const GroupRules rules = all(GroupRule::interpolate);
  const auto eight = [&](std::initializer_list<std::pair<int, std::int32_t>> coded) {
    return ruled(clip_of({make_frame(0, coded)}), rules).frames.at(0).value[8];
  };
  EXPECT_EQ(eight({{9, 1}, {55, 2}, {56, 3}}), 1);
  EXPECT_EQ(eight({{55, 2}, {56, 3}}), 2);
  EXPECT_EQ(eight({{56, 3}}), 3);
  const Sequence across = clip_of({make_frame(0, {{56, 3}})});
  EXPECT_EQ(ruled(across, rules, {.mirror = false}).frames[0], make_frame(0, {{9, 3}, {56, 3}}));
  EXPECT_EQ(ruled(across, rules, {.lips = false}).frames[0], make_frame(0, {{55, 3}, {56, 3}}));
}

TEST(FillByRule, OnlyFapsOfTheFrameAreSources) {
  // FAP 31 was sent once; when it is no longer coded, 32 stays where it was.
  const Sequence clip = clip_of({make_frame(0, {{31, 10}, {32, 20}}), make_frame(1, {{31, 11}}),
                                 make_frame(2, {{33, 1}}), make_frame(3, {{32, 7}})});
  const Sequence f = ruled(clip, all(GroupRule::interpolate));
  const std::int32_t left[] = {10, 11, 11, 7};
  const std::int32_t right[] = {20, 11, 11, 7};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(f.frames[i].value[31], left[i]) << i;
    EXPECT_EQ(f.frames[i].value[32], right[i]) << i;
  }
}

TEST(FillByRule, ADerivedValueIsHeldWhenTheRuleChanges) {
  const Sequence clip = clip_of({make_frame(0, {{39, 50}}), make_frame(1, {{39, 60}})});
  const GroupRules rules[] = {all(GroupRule::interpolate), all(GroupRule::hold)};
  const Result<Sequence> f = fill(clip, rules, {});
  ASSERT_TRUE(f);
  EXPECT_EQ(f->frames[0], make_frame(0, {{39, 50}, {40, 50}}));
  EXPECT_EQ(f->frames[1], make_frame(1, {{39, 60}, {40, 50}}));
}

TEST(FillByRule, LikeThePublicDecoder) {
  const Sequence clip = clip_of({make_frame(0, {{6, 1}, {7, 2}, {4, 9}}), make_frame(1, {{6, 3}})});
  const FillOptions options{.like_public_decoder = true};
  for (const GroupRule rule : {GroupRule::unknown, GroupRule::hold, GroupRule::interpolate}) {
    EXPECT_EQ(ruled(clip, all(rule), options).frames[1],
              make_frame(1, {{4, 9}, {6, 3}, {7, 3}}));  // the sides, no lips
  }
  EXPECT_EQ(filled(clip, options).frames[1], make_frame(1, {{4, 9}, {6, 3}, {7, 3}}));
}

// What the rules ask for, FAP by FAP, from the frame shown before.
std::int32_t expected_value(const Frame& coded, const Frame& before, int fap, GroupRule rule) {
  if (coded.mask[std::size_t(fap)]) return coded.value[std::size_t(fap)];
  if (rule == GroupRule::interpolate) {
    const int partner = info(fap).partner;
    for (const int source : {info(fap).mirror, partner, partner ? info(partner).mirror : 0}) {
      if (source != 0 && coded.mask[std::size_t(source)]) return coded.value[std::size_t(source)];
    }
  }
  return before.value[std::size_t(fap)];
}

TEST(FillByRule, RandomMasksAndRules) {
  made::Random random(12);
  for (int round = 0; round < 60; ++round) {
    const Sequence clip = made::random_sequence(random, 10);
    std::vector<GroupRules> rules(clip.frames.size());
    for (GroupRules& frame : rules) {
      for (GroupRule& rule : frame) {
        rule = random.chance(50) ? GroupRule::hold : GroupRule::interpolate;
      }
    }
    const Result<Sequence> f = fill(clip, rules, {.keep_high_level = true});
    ASSERT_TRUE(f);
    Frame before;
    std::size_t next = 0;
    for (const Frame& shown : f->frames) {
      const bool skipped = shown.number != clip.frames[next].number;
      const Frame& coded = skipped ? before : clip.frames[next];
      for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
        const GroupRule rule =
            skipped ? GroupRule::hold : rules[next][std::size_t(info(fap).group - 1)];
        const std::int32_t want =
            skipped ? before.value[std::size_t(fap)] : expected_value(coded, before, fap, rule);
        ASSERT_EQ(shown.value[std::size_t(fap)], want)
            << "frame " << shown.number << " FAP " << fap;
        ASSERT_TRUE(shown.mask[std::size_t(fap)] || want == 0);
      }
      if (!skipped) ++next;
      before = shown;
    }
    ASSERT_EQ(next, clip.frames.size());
  }
}

TEST(FillByRule, FillingAgainChangesNothing) {
  made::Random random(13);
  for (int round = 0; round < 60; ++round) {
    const Sequence clip = made::random_sequence(random, 10);
    GroupRules rules;
    for (GroupRule& rule : rules) {
      rule = random.chance(50) ? GroupRule::hold : GroupRule::interpolate;
    }
    for (const bool smooth : {false, true}) {
      const FillOptions options{.interpolate = smooth, .keep_high_level = random.chance(50)};
      const Sequence f = ruled(clip, rules, options);
      ASSERT_EQ(ruled(f, rules, options), f);
    }
  }
}

TEST(FillByRule, UnknownRulesAreThoseOfText) {
  made::Random random(14);
  for (int round = 0; round < 40; ++round) {
    const Sequence clip = made::random_sequence(random, 10);
    const FillOptions options{.mirror = random.chance(70),
                              .lips = random.chance(70),
                              .prefer_partner = random.chance(50)};
    ASSERT_EQ(ruled(clip, all(GroupRule::unknown), options), filled(clip, options));
    // Holding is what text without any derivation does.
    ASSERT_EQ(ruled(clip, all(GroupRule::hold), options),
              filled(clip, {.mirror = false, .lips = false}));
  }
}

TEST(FillByRule, NeedsOneEntryForEachFrame) {
  const Sequence clip = clip_of({make_frame(0, {{3, 1}}), make_frame(1, {{3, 2}})});
  const Result<Sequence> f = fill(clip, std::vector<GroupRules>(3), {});
  ASSERT_FALSE(f);
  EXPECT_EQ(f.error().code, Code::invalid_argument);
  const Result<Sequence> none = fill(clip, std::vector<GroupRules>(), {});
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, clip);
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

}  // namespace fill_test
}  // namespace animeme::fap
