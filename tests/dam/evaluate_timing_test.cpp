// Lag and misalignment of motion that was moved by a known time, and the bootstrap.
#include <gtest/gtest.h>

#include "dam/evaluation/evaluate_bootstrap.h"
#include "dam/script/phones.h"
#include "tests/dam/evaluate_pairs.h"

namespace animeme::dam {
namespace evaluate_timing_test {

using sentence_pairs::pair_of;
using sentence_pairs::scale_of;
using sentence_pairs::vowels;
using sentence_pairs::wave;

Evaluation moved_by(double frames) {
  const auto pair = pair_of(
      {3}, vowels(), [](int, int i) { return wave(i); },
      [&](int, int i) { return wave(i - frames); });
  const auto result = score({&pair, 1}, {.scale = scale_of({3})});
  EXPECT_TRUE(result);
  return result ? *result : Evaluation();
}

TEST(Timing, AMovedCopyHasItsLag) {
  for (const double frames : {-4.0, -2.0, -0.5, 0.25, 1.0, 2.5, 3.0}) {
    const Evaluation e = moved_by(frames);
    ASSERT_TRUE(e.timing.all.lag) << frames;
    EXPECT_NEAR(*e.timing.all.lag, frames * 40, 3) << frames;
    EXPECT_GT(e.timing.all.correlation, 0.98) << frames;
  }
}

TEST(Timing, LimitsOfDetection) {
  EXPECT_EQ(moved_by(1).timing.sync, Sync::in_sync);      // +40 ms
  EXPECT_EQ(moved_by(1.3).timing.sync, Sync::face_late);  // +52 ms
  EXPECT_EQ(moved_by(-3).timing.sync, Sync::in_sync);     // -120 ms
  EXPECT_EQ(moved_by(-3.4).timing.sync, Sync::face_early);
  EXPECT_STREQ(sync_text(Sync::face_late), "face late (sound early)");
}

TEST(Timing, ClassesHaveLagsOfTheirOwn) {
  // The first half of the sentence, all AE, is in time; the second half, all S, is 80 ms late.
  std::vector<std::string> labels(36, "AE");
  for (std::size_t i = 18; i < 36; ++i) labels[i] = "S";
  const auto recorded = [](int, int i) { return wave(i); };
  const auto made = [](int, int i) { return i < 50 ? wave(i) : wave(i - 2); };
  const auto pair = pair_of({3}, sentence_pairs::script_of(labels), recorded, made);
  const auto e = score({&pair, 1}, {.scale = scale_of({3})});
  ASSERT_TRUE(e);
  const auto lag_of = [&](PhoneClass c) {
    for (const LagScore& one : e->timing.classes)
      if (one.name == phone_class_name(c)) return one.lag.value_or(-1000);
    return -2000.0;
  };
  EXPECT_NEAR(lag_of(PhoneClass::mid_vowel), 0, 8);
  EXPECT_NEAR(lag_of(PhoneClass::alveolar), 80, 8);
}

TEST(Timing, WarpingFindsAMovedBump) {
  const auto bump = [](double middle, int i) {
    return 100 * std::exp(-std::pow((i - middle) / 4.0, 2));
  };
  for (const int frames : {-3, 0, 2}) {
    // Half as high: what is compared is the shape.
    const auto pair = pair_of(
        {3}, vowels(), [&](int, int i) { return bump(50, i); },
        [&](int, int i) { return 0.5 * bump(50 + frames, i); });
    const auto e = score({&pair, 1}, {.scale = scale_of({3})});
    ASSERT_TRUE(e);
    EXPECT_EQ(e->timing.extremes, 2u);  // fastest up, fastest down
    EXPECT_NEAR(e->timing.misalignment, std::abs(frames) * 40, 1e-6) << frames;
    EXPECT_NEAR(e->timing.offset, frames * 40, 1e-6) << frames;
  }
}

// Sentences that differ, and errors that are `error` in every frame of all.
Evaluation with_error(double error, double spread = 0) {
  std::vector<SentencePair> pairs;
  for (int k = 0; k < 12; ++k) {
    const double own = error + spread * (k % 4 - 1.5);
    pairs.push_back(pair_of(
        {4, 5}, vowels(), [k](int fap, int i) { return wave(i + 7 * k + fap); },
        [k, own](int fap, int i) { return wave(i + 7 * k + fap) + own; }));
    pairs.back().recorded.id = "s" + std::to_string(k);
  }
  const auto result = score(pairs, {.scale = scale_of({4, 5})});
  EXPECT_TRUE(result);
  return result ? *result : Evaluation();
}

TEST(Bootstrap, AConstantDifferenceHasNoSpread) {
  const auto d = paired_difference(with_error(30), with_error(10));
  ASSERT_TRUE(d) << d.error().describe();
  EXPECT_EQ(d->sentences, 12u);
  EXPECT_EQ(d->draws, 1000);
  EXPECT_NEAR(d->nrmse.a, 0.3, 1e-9);
  EXPECT_NEAR(d->nrmse.b, 0.1, 1e-9);
  EXPECT_NEAR(d->nrmse.difference, 0.2, 1e-9);
  EXPECT_NEAR(d->nrmse.low, 0.2, 1e-9);
  EXPECT_NEAR(d->nrmse.high, 0.2, 1e-9);
  EXPECT_EQ(d->nrmse.below, 0);
  EXPECT_NEAR(d->l2.low, 0.2 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(d->l2.high, 0.2 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(d->gap_rmse.low, 40, 1e-9);  // both lips
  EXPECT_NEAR(d->gap_rmse.high, 40, 1e-9);
}

TEST(Bootstrap, TheIntervalHoldsTheDifference) {
  const Evaluation a = with_error(30, 8), b = with_error(27, 2);
  const auto d = paired_difference(a, b);
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->nrmse.a, a.nrmse, 1e-12);
  EXPECT_NEAR(d->nrmse.b, b.nrmse, 1e-12);
  EXPECT_LT(d->nrmse.low, d->nrmse.difference);
  EXPECT_GT(d->nrmse.high, d->nrmse.difference);
  const auto again = paired_difference(a, b);
  EXPECT_EQ(d->nrmse.low, again->nrmse.low);
  const auto other = paired_difference(a, b, {.seed = 2});
  EXPECT_NE(d->nrmse.low, other->nrmse.low);
  EXPECT_NEAR(d->nrmse.low, other->nrmse.low, 0.01);
  const auto back = paired_difference(b, a);
  EXPECT_NEAR(back->nrmse.low, -d->nrmse.high, 1e-12);
  const auto narrow = paired_difference(a, b, {.coverage = 0.5});
  EXPECT_GT(narrow->nrmse.low, d->nrmse.low);
}

TEST(Bootstrap, RefusesWhatIsNotPaired) {
  const Evaluation a = with_error(30);
  Evaluation b = with_error(10);
  EXPECT_FALSE(paired_difference(a, b, {.draws = 0}));
  EXPECT_FALSE(paired_difference(a, b, {.coverage = 1}));
  b.per_utterance[3].id = "other";
  EXPECT_FALSE(paired_difference(a, b));
  b = with_error(10);
  b.per_utterance.pop_back();
  EXPECT_FALSE(paired_difference(a, b));
  EXPECT_FALSE(paired_difference({}, {}));
}

}  // namespace evaluate_timing_test
}  // namespace animeme::dam
