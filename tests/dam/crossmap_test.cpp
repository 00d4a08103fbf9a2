#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dam/crossmap/blend.h"
#include "dam/crossmap/key_shapes.h"
#include "dam/crossmap/retarget.h"
#include "dam/maths/random.h"

namespace animeme::dam {
namespace crossmap_test {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

constexpr double kGone = std::numeric_limits<double>::quiet_NaN();

// A mouth of four points in a picture: upper, lower, left, right.
PointTrack track_of(std::vector<double> values) {
  return {"take", {25, 1}, 2, {"U", "L", "A", "B"}, std::move(values)};
}

const std::vector<double> kOpen = {0, -1, 0, 6, -1, 1, 1, 1};
const std::vector<double> kWide = {0, 0, 0, 1, 3, 0, -3, 0};
const std::vector<double> kRound = {0, -1, 0, 1, -2, 0, 2, 0};

KeyShapes three_keys() {
  KeyShapes keys{{"open", "wide", "round"}, {}};
  for (const auto& shape : {kOpen, kWide, kRound}) {
    keys.values.insert(keys.values.end(), shape.begin(), shape.end());
  }
  return keys;
}

// Frames that are mixtures of the three, with their coefficients.
PointTrack mixtures(std::size_t frames, std::vector<double>& alpha) {
  Random random(3);
  std::vector<double> values;
  for (std::size_t i = 0; i < frames; ++i) {
    double a[3];
    for (double& value : a) value = std::max(0.0, random.between(-0.4, 1));
    alpha.insert(alpha.end(), a, a + 3);
    for (std::size_t k = 0; k < 8; ++k) {
      values.push_back(a[0] * kOpen[k] + a[1] * kWide[k] + a[2] * kRound[k]);
    }
  }
  return track_of(values);
}

TEST(FitBlend, FindsTheCoefficientsThatFramesWereMadeWith) {
  std::vector<double> alpha;
  const PointTrack track = mixtures(60, alpha);
  const auto blend = fit_blend(track, three_keys(), {}, {.ridge = 0});
  ASSERT_TRUE(blend) << blend.error().describe();
  EXPECT_THAT(blend->weights, Pointwise(DoubleNear(1e-12), alpha));
  EXPECT_LT(blend->residual, 1e-12);
  EXPECT_EQ(blend->partly + blend->unseen, 0u);
}

TEST(FitBlend, FitsTheRestWherePointsAreMissingAndBridgesFramesWithoutAny) {
  std::vector<double> alpha;
  PointTrack track = mixtures(12, alpha);
  for (std::size_t k = 2; k < 4; ++k) track.frame(3)[k] = kGone;  // the lower lip
  for (std::size_t i : {6u, 7u}) std::fill(track.frame(i).begin(), track.frame(i).end(), kGone);
  const Region lower{"lower", {1}}, all{"all", {0, 1, 2, 3}};
  const Region regions[] = {lower, all};
  const auto blend = fit_blend(track, three_keys(), regions, {.ridge = 0});
  ASSERT_TRUE(blend) << blend.error().describe();
  EXPECT_EQ(blend->partly, 1u);
  EXPECT_EQ(blend->unseen, 2u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(blend->measured[i], i != 6 && i != 7);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_NEAR(blend->weights[9 + s], alpha[9 + s], 1e-12);  // three points tell as much
    const double a = blend->weights[15 + s], b = blend->weights[24 + s];
    EXPECT_NEAR(blend->weights[18 + s], a + (b - a) / 3, 1e-12);
    EXPECT_NEAR(blend->weights[21 + s], a + 2 * (b - a) / 3, 1e-12);
  }
  EXPECT_TRUE(std::isnan(blend->residuals[2 * 3]));
  EXPECT_LT(blend->residuals[2 * 3 + 1], 1e-12);
}

TEST(FitBlend, TellsWhatIsLeftByRegion) {
  PointTrack track = track_of(kOpen);
  track.values[4] += 0.3;  // a corner to the left, which no key shape does alone
  const Region regions[] = {{"corners", {2, 3}}, {"lips", {0, 1}}};
  const auto blend = fit_blend(track, three_keys(), regions);
  ASSERT_TRUE(blend);
  const std::vector<double> made = blended(*blend, three_keys(), 0);
  const auto off = [&](std::size_t p) {
    return std::pow(made[2 * p] - track.values[2 * p], 2) +
           std::pow(made[2 * p + 1] - track.values[2 * p + 1], 2);
  };
  EXPECT_NEAR(blend->residuals[0], std::sqrt((off(2) + off(3)) / 2), 1e-12);
  EXPECT_NEAR(blend->residuals[1], std::sqrt((off(0) + off(1)) / 2), 1e-12);
  EXPECT_GT(blend->residuals[0], 0.05);
}

TEST(FitBlend, ConvexNeverGoesBeyondTheKeyShapes) {
  std::vector<double> values;
  for (const double k : kOpen) values.push_back(1.5 * k);
  const auto free = fit_blend(track_of(values), three_keys());
  const auto convex = fit_blend(track_of(values), three_keys(), {}, {.convex = true});
  ASSERT_TRUE(free && convex);
  EXPECT_NEAR(free->weights[0], 1.5, 1e-3);
  EXPECT_NEAR(convex->weights[0], 1, 1e-5);
  EXPECT_LE(convex->weights[0] + convex->weights[1] + convex->weights[2], 1 + 1e-5);
  // Within them it is the same fit.
  for (double& value : values) value /= 3;
  const auto half = fit_blend(track_of(values), three_keys(), {}, {.convex = true});
  ASSERT_TRUE(half);
  EXPECT_THAT(half->weights, Pointwise(DoubleNear(1e-6), std::vector<double>{0.5, 0, 0}));
}

TEST(FitBlend, ContactsHoldLipsTogetherThatOtherPointsWouldOpen) {
  // Closed lips, corners that no key shape has: without contacts the jaw opens for them.
  const PointTrack track = track_of({0, 0, 0, 0, -2, 2, 2, 2});
  const auto gap = [&](const BlendOptions& options) {
    const auto blend = fit_blend(track, three_keys(), {}, options);
    EXPECT_TRUE(blend);
    const std::vector<double> made = blended(*blend, three_keys(), 0);
    return made[3] - made[1];
  };
  const double open = gap({});
  EXPECT_GT(open, 1);
  EXPECT_LT(gap({.contacts = {{0, 1}}, .contact_weight = 10}), 0.3 * open);
}

TEST(FitBlend, SmoothingKeepsWhatIsStillAndTakesJitter) {
  std::vector<double> values;
  for (std::size_t i = 0; i < 50; ++i) {
    for (const double k : kWide) values.push_back((0.5 + (i % 2 == 0 ? 0.1 : -0.1)) * k);
  }
  const auto rough = fit_blend(track_of(values), three_keys(), {}, {.ridge = 0});
  const auto smooth = fit_blend(track_of(values), three_keys(), {}, {.ridge = 0, .smooth = 0.08});
  ASSERT_TRUE(rough && smooth);
  for (std::size_t i = 10; i < 40; ++i) {
    EXPECT_NEAR(std::abs(rough->weights[3 * i + 1] - 0.5), 0.1, 1e-9);
    EXPECT_NEAR(smooth->weights[3 * i + 1], 0.5, 1e-3);
  }
  EXPECT_GT(smooth->residual, rough->residual);
}

TEST(FitBlend, SaysWhatIsWrong) {
  const PointTrack track = track_of(kOpen);
  const auto error = [&](const KeyShapes& keys, const BlendOptions& options) {
    const auto blend = fit_blend(track, keys, {}, options);
    EXPECT_FALSE(blend);
    return blend ? std::string() : blend.error().message;
  };
  EXPECT_THAT(error({}, {}), HasSubstr("no key shape"));
  EXPECT_THAT(error({{"a"}, {1, 2}}, {}), HasSubstr("other points"));
  KeyShapes broken = three_keys();
  broken.values[2] = kGone;
  EXPECT_THAT(error(broken, {}), HasSubstr("open lacks the point L"));
  EXPECT_THAT(error(three_keys(), {.weights = {1}}), HasSubstr("one weight"));
  EXPECT_THAT(error(three_keys(), {.contacts = {{0, 9}}}), HasSubstr("no such point"));
  EXPECT_THAT(error(three_keys(), {.smooth = 2}), HasSubstr("second"));
  PointTrack blind = track;
  std::fill(blind.values.begin(), blind.values.end(), kGone);
  const auto blend = fit_blend(blind, three_keys());
  ASSERT_FALSE(blend);
  EXPECT_EQ(blend.error().code, Code::not_found);
}

TEST(KeyFrames, AreTheMiddlesOfHeapsInAllRecordingsTogether) {
  Random random(9);
  std::vector<PointTrack> tracks;
  for (int t = 0; t < 2; ++t) {
    std::vector<double> values;
    for (int i = 0; i < 40; ++i) {
      const auto& shape = t == 0 ? (i < 30 ? kOpen : kWide) : kRound;
      for (const double k : shape) values.push_back(k + random.between(-0.1, 0.1));
    }
    tracks.push_back(track_of(values));
  }
  const auto found = find_key_frames(tracks, {}, {.count = 3});
  ASSERT_TRUE(found) << found.error().describe();
  ASSERT_EQ(found->keys.size(), 3u);
  EXPECT_EQ(found->compared, 80u);
  EXPECT_EQ(found->keys[0].track, 0u);
  EXPECT_LT(found->keys[0].frame, 30u);
  EXPECT_NEAR(found->keys[0].share, 30.0 / 80, 1e-9);
  EXPECT_EQ(found->keys[1].track, 0u);
  EXPECT_GE(found->keys[1].frame, 30u);
  EXPECT_EQ(found->keys[2].track, 1u);
  EXPECT_NEAR(found->keys[2].share, 0.5, 1e-9);
  // More frames than are compared: every n-th.
  const auto fewer = find_key_frames(tracks, {}, {.count = 3, .most_frames = 20});
  ASSERT_TRUE(fewer);
  EXPECT_EQ(fewer->compared, 20u);
  EXPECT_EQ(fewer->keys.size(), 3u);
  for (const KeyFrame& key : fewer->keys) EXPECT_EQ((key.track * 40 + key.frame) % 4, 0u);
}

TEST(KeyFrames, DoNotLookAtPointsWithoutWeightOrAtFramesWithHoles) {
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> shape = i % 2 == 0 ? kOpen : kWide;
    shape[6] = i == 4 ? kGone : 50.0 * i;  // a point that flies away
    values.insert(values.end(), shape.begin(), shape.end());
  }
  const PointTrack track = track_of(values);
  const std::vector<double> weights = {1, 1, 1, 0};
  const auto found = find_key_frames({&track, 1}, weights, {.count = 2});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keys.size(), 2u);
  EXPECT_EQ(found->compared, 20u);
  const auto all = find_key_frames({&track, 1}, {}, {.count = 2});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->compared, 19u);
}

TEST(RestingShape, IsTheStillestStretch) {
  std::vector<double> values;
  for (int i = 0; i < 40; ++i) {
    const double open = i < 20 || i >= 30 ? std::sin(i) : 0.25;
    for (const double k : kOpen) values.push_back(k * open + 10);
  }
  const PointTrack track = track_of(values);
  const auto rest = resting_shape({&track, 1});
  ASSERT_TRUE(rest);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR((*rest)[k], kOpen[k] * 0.25 + 10, 1e-12);
}

// A head that turns and moves, with a mouth that opens, in space.
TEST(HoldHeadStill, LeavesWhatTheFaceDoes) {
  const std::vector<double> head = {-3, 5, 1, 3, 5, 1, 0, 7, 3, 0, 2, 4}, mouth = {0, -1, 3};
  PointTrack track{"take", {50, 1}, 3, {"a", "b", "c", "d", "mouth"}, {}};
  std::vector<double> neutral = head;
  neutral.insert(neutral.end(), mouth.begin(), mouth.end());
  for (int i = 0; i < 30; ++i) {
    const double turn = 0.02 * i, c = std::cos(turn), s = std::sin(turn);
    for (std::size_t p = 0; p < 5; ++p) {
      double x = neutral[3 * p], y = neutral[3 * p + 1], z = neutral[3 * p + 2];
      if (p == 4) y -= 0.1 * i;
      track.values.insert(track.values.end(), {c * x + s * z + 0.3 * i, y - 1, c * z - s * x});
    }
  }
  track.frame(7)[0] = kGone;  // three others are enough
  for (std::size_t p = 0; p < 2; ++p) track.frame(8)[3 * p] = kGone;
  const std::size_t still[] = {0, 1, 2, 3};
  const auto lost = hold_head_still(track, still, neutral);
  ASSERT_TRUE(lost) << lost.error().describe();
  EXPECT_EQ(*lost, 1u);
  subtract(track, neutral);
  for (std::size_t i = 0; i < 30; ++i) {
    if (i == 8) {
      EXPECT_FALSE(track.seen(i, 4));
      continue;
    }
    EXPECT_NEAR(track.frame(i)[12], 0, 1e-9);
    EXPECT_NEAR(track.frame(i)[13], -0.1 * double(i), 1e-9);
    EXPECT_NEAR(track.frame(i)[14], 0, 1e-9);
  }
}

// A target whose two controls overlap, and whose third is out of reach.
Character character() {
  Character out;
  out.controls = {"jaw", "wide"};
  out.lows = {0, 0};
  out.highs = {1, 1};
  out.rows = 3;
  out.moves = {1, 0, 1, 1, 0, 2};                   // jaw (1, 1, 0), wide (0, 1, 2)
  out.keys = {0.5, 0.5, 0, 0, 0.25, 0.5, 2, 2, 0};  // half a jaw, a quarter wide, too much jaw
  return out;
}

TEST(FitControls, MakesTheMixedVerticesWithinItsLimits) {
  Blend blend;
  blend.weights = {1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 2, 0};
  blend.measured = {true, true, true, false};
  const auto made = fit_controls(blend, {25, 1}, character(), {.ridge = 0});
  ASSERT_TRUE(made) << made.error().describe();
  const std::vector<double> expected = {0.5, 0, 0.5, 0.25, 1, 0, 0, 0.5};
  // The third frame asks for two jaws; one is the limit, and some width makes up for the second
  // row.
  EXPECT_THAT(
      std::vector<double>(made->signal.values.begin(), made->signal.values.begin() + 4),
      Pointwise(DoubleNear(1e-12), std::vector<double>(expected.begin(), expected.begin() + 4)));
  EXPECT_EQ(made->signal.at(2, 0), 1);
  EXPECT_NEAR(made->signal.at(2, 1), 0.2, 1e-12);
  EXPECT_NEAR(made->residuals[2], std::sqrt((1 + 0.64 + 0.16) / 3), 1e-7);
  EXPECT_NEAR(made->residuals[0], 0, 1e-7);
  EXPECT_EQ(made->limited, 1u);
  EXPECT_THAT(made->signal.measured, ElementsAre(true, true, true, false));
  EXPECT_THAT(made->signal.names, ElementsAre("jaw", "wide"));
}

TEST(MixControls, TakesTheCoefficientsAsTheSignal) {
  Blend blend;
  blend.weights = {1, 0, 0.5, 0.5, 0, 2};
  blend.measured = {true, true, true};
  const auto made = mix_controls(blend, {25, 1}, character(), {0.2, 0.4, 0.6, 0.8});
  ASSERT_TRUE(made);
  EXPECT_THAT(made->signal.values,
              Pointwise(DoubleNear(1e-12), std::vector<double>{0.2, 0.4, 0.4, 0.6, 1, 1}));
  EXPECT_EQ(made->limited, 1u);
  EXPECT_TRUE(made->signal.measured.empty());
}

TEST(FitControls, SaysWhatIsWrong) {
  Blend blend;
  blend.weights = {1, 0, 0};
  blend.measured = {true};
  const auto message = [&](const Character& target) {
    const auto made = fit_controls(blend, {25, 1}, target);
    EXPECT_FALSE(made);
    return made ? std::string() : made.error().message;
  };
  Character target = character();
  target.controls.clear();
  EXPECT_THAT(message(target), HasSubstr("no controls"));
  target = character();
  target.lows[1] = 2;
  EXPECT_THAT(message(target), HasSubstr("limits of wide"));
  target = character();
  target.moves.pop_back();
  EXPECT_THAT(message(target), HasSubstr("one size"));
  target = character();
  target.keys.resize(6);
  EXPECT_THAT(message(target), HasSubstr("key shapes"));
}

}  // namespace crossmap_test
}  // namespace animeme::dam
