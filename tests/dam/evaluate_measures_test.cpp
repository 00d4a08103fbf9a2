// Measures of evaluate() on motion with known answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dam/evaluate_pairs.h"

namespace animeme::dam {
namespace evaluate_measures_test {

using sentence_pairs::kFrames;
using sentence_pairs::pair_of;
using sentence_pairs::scale_of;
using sentence_pairs::score_one;
using sentence_pairs::score_with;
using sentence_pairs::script_of;
using sentence_pairs::vowels;
using sentence_pairs::wave;
using sentence_pairs::with_bilabial;

TEST(Measures, IdenticalMotionHasNoError) {
  const std::vector<int> faps = {3, 4, 5, 6, 7, 12, 13};
  const auto value = [](int fap, int i) { return wave(i + 3 * fap); };
  const Evaluation e = score_one(pair_of(faps, vowels(), value, value), faps);
  EXPECT_EQ(e.nrmse, 0);
  EXPECT_EQ(e.l2, 0);
  EXPECT_NEAR(e.correlation, 1, 1e-12);
  ASSERT_EQ(e.measures.size(), 4u);
  for (const SeriesScore& one : e.measures) {
    EXPECT_EQ(one.rmse, 0) << one.name;
    EXPECT_EQ(one.nrmse, 0) << one.name;
    EXPECT_EQ(one.largest, 0) << one.name;
    EXPECT_NEAR(one.correlation, 1, 1e-12) << one.name;
  }
  ASSERT_TRUE(e.timing.all.lag);
  EXPECT_NEAR(*e.timing.all.lag, 0, 1e-9);
  EXPECT_EQ(e.timing.sync, Sync::in_sync);
  EXPECT_GT(e.timing.extremes, 20u);
  EXPECT_EQ(e.timing.misalignment, 0);
  EXPECT_NEAR(e.dynamics.velocity, 1, 1e-12);
  EXPECT_NEAR(e.dynamics.acceleration, 1, 1e-12);
  EXPECT_NEAR(e.dynamics.jerk, 1, 1e-12);
  EXPECT_NEAR(e.dynamics.range, 1, 1e-12);
  EXPECT_NEAR(e.dynamics.velocity_correlation, 1, 1e-12);
  EXPECT_EQ(e.closure.false_closures, 0u);
}

TEST(Measures, GainAndOffsetOfAnotherSpeakerAreTakenOff) {
  const std::vector<int> faps = {3, 4};
  const auto recorded = [](int fap, int i) { return 3 * wave(i + 3 * fap) + 500; };
  const auto made = [](int fap, int i) { return fap == 3 ? wave(i + 9) : -wave(i + 12); };
  const Evaluation e = score_one(pair_of(faps, vowels(), recorded, made), faps);
  EXPECT_GT(e.controls[0].nrmse, 5);
  EXPECT_NEAR(e.controls[0].gain, 3, 1e-9);
  EXPECT_NEAR(e.controls[0].offset, 500, 1e-6);
  EXPECT_NEAR(e.controls[0].fitted_nrmse, 0, 1e-6);
  // What moves the wrong way is not turned round: a constant is all that is left of it.
  EXPECT_EQ(e.controls[1].gain, 0);
  EXPECT_EQ(e.controls[1].fitted_nrmse, 1);
  EXPECT_NEAR(e.fitted_nrmse, 0.5, 1e-6);
}

TEST(Measures, DerivedMeasuresAreSumsOfFaps) {
  const std::vector<int> faps = {3, 4, 5, 6, 7, 12, 13};
  const auto recorded = [](int fap, int i) { return wave(i + 3 * fap); };
  // Every FAP is off by its own number.
  const auto made = [&](int fap, int i) { return recorded(fap, i) + fap; };
  const Evaluation e = score_one(pair_of(faps, vowels(), recorded, made), faps);
  ASSERT_EQ(e.measures.size(), 4u);
  EXPECT_EQ(e.measures[0].name, "inner_gap");
  EXPECT_NEAR(e.measures[0].rmse, 9, 1e-9);
  EXPECT_NEAR(e.measures[1].rmse, 13, 1e-9);
  EXPECT_NEAR(e.measures[2].rmse, 3, 1e-9);
  EXPECT_EQ(e.measures[3].name, "corner_height");
  EXPECT_NEAR(e.measures[3].rmse, 12.5, 1e-9);
  EXPECT_NEAR(e.measures[3].largest, 12.5, 1e-9);
}

TEST(Measures, AScaledCopyHasItsFactorInTheDynamics) {
  const auto recorded = [](int, int i) { return wave(i) + 50; };
  const auto made = [](int, int i) { return 0.6 * wave(i) - 20; };
  const Evaluation e = score_one(pair_of({3}, vowels(), recorded, made), {3});
  EXPECT_NEAR(e.dynamics.velocity, 0.6, 1e-9);
  EXPECT_NEAR(e.dynamics.acceleration, 0.6, 1e-9);
  EXPECT_NEAR(e.dynamics.jerk, 0.6, 1e-9);
  EXPECT_NEAR(e.dynamics.range, 0.6, 1e-9);
  EXPECT_NEAR(e.dynamics.velocity_correlation, 1, 1e-9);
  EXPECT_NEAR(e.correlation, 1, 1e-9);
  ASSERT_EQ(e.series_dynamics.size(), 2u);  // FAP 3 and the jaw
  EXPECT_EQ(e.series_dynamics[1].name, "jaw");
}

TEST(Measures, DynamicsOfThePartsOfAMouth) {
  const std::vector<int> faps = {3, 4, 8, 6, 12, 14};  // FAP 14 is of no part and not scored
  const auto recorded = [](int, int i) { return wave(i); };
  const auto made = [](int fap, int i) {
    return wave(i) * (fap == 3 ? 0.5 : fap == 4 ? 0.6 : fap == 8 ? 0.8 : fap == 6 ? 0.2 : 0.4);
  };
  const Evaluation e = score_one(pair_of(faps, vowels(), recorded, made), faps);
  ASSERT_EQ(e.group_dynamics.size(), 3u);  // no lower lip
  EXPECT_EQ(e.group_dynamics[0].name, "jaw");
  EXPECT_NEAR(e.group_dynamics[0].velocity, 0.5, 1e-9);
  EXPECT_EQ(e.group_dynamics[1].name, "upper lip");
  EXPECT_NEAR(e.group_dynamics[1].velocity, 0.7, 1e-9);
  EXPECT_EQ(e.group_dynamics[2].name, "corners");
  EXPECT_NEAR(e.group_dynamics[2].velocity, 0.3, 1e-9);
  EXPECT_NEAR(e.group_dynamics[2].range, 0.3, 1e-9);
}

TEST(Measures, TheRangeHeedsNoOutliers) {
  const auto ramp = [](int, int i) { return double(i); };
  // Four of a hundred frames are far off, two on each side.
  const auto made = [](int, int i) {
    return i < 2 ? -1000.0 : i >= kFrames - 2 ? 1000.0 : 0.5 * i;
  };
  const Evaluation e = score_one(pair_of({3}, vowels(), ramp, made), {3});
  EXPECT_NEAR(e.dynamics.range, 0.5, 1e-9);
}

TEST(Measures, AStillFaceHasNoDynamics) {
  const auto still = [](int, int) { return 7.0; };
  const Evaluation e = score_one(pair_of(
                                     {3}, vowels(), [](int, int i) { return wave(i); }, still),
                                 {3});
  EXPECT_EQ(e.dynamics.velocity, 0);
  EXPECT_EQ(e.dynamics.range, 0);
  EXPECT_FALSE(e.timing.all.lag);
  EXPECT_EQ(e.timing.sync, Sync::unknown);
  EXPECT_EQ(e.timing.extremes, 0u);
}

TEST(Measures, SilenceIsScoredApart) {
  // Speech from 0.2 s to 1.2 s: with its margin frames 0 to 35 of 100.
  const Script script = script_of(std::vector<std::string>(10, "AE"));
  const auto recorded = [](int, int i) { return wave(i); };
  const auto made = [](int, int i) { return wave(i) + (i <= 35 ? 10 : 30); };
  auto pair = pair_of({3}, script, recorded, made);
  Evaluation e = score_one(pair, {3});
  EXPECT_EQ(e.frames, 36u);
  EXPECT_EQ(e.silence.frames, 64u);
  EXPECT_NEAR(e.nrmse, 0.1, 1e-9);
  EXPECT_NEAR(e.silence.nrmse, 0.3, 1e-9);
  EXPECT_NEAR(e.silence.l2, 0.3, 1e-9);
  // Interpolated frames belong to neither.
  pair.recorded.signal.measured.assign(kFrames, true);
  pair.recorded.signal.measured[10] = pair.recorded.signal.measured[90] = false;
  e = score_one(pair, {3});
  EXPECT_EQ(e.frames, 35u);
  EXPECT_EQ(e.silence.frames, 63u);
}

TEST(Breakdown, FramesBelongToTheirPhones) {
  std::vector<std::string> labels(36, "AE");
  labels[9] = "AY";  // 1.1 s to 1.2 s, frames 28 and 29
  const auto recorded = [](int, int) { return 0.0; };
  const auto made = [](int, int i) { return i == 28 ? 20.0 : i == 29 ? 40.0 : 10.0; };
  const Evaluation e = score_one(pair_of({3}, script_of(labels), recorded, made), {3});
  ASSERT_EQ(e.breakdown.phones.size(), 3u);  // SIL AE AY
  const GroupScore& ay = e.breakdown.phones[2];
  EXPECT_EQ(ay.name, "AY");
  EXPECT_EQ(ay.phones, 1u);
  EXPECT_EQ(ay.frames, 2u);
  EXPECT_NEAR(ay.nrmse, std::sqrt((0.04 + 0.16) / 2), 1e-9);
  EXPECT_NEAR(ay.l2, 0.3, 1e-9);
  EXPECT_EQ(e.breakdown.phones[1].phones, 35u);
  EXPECT_NEAR(e.breakdown.phones[1].nrmse, 0.1, 1e-9);
  // AY begins as viseme 10 and ends as 12.
  const auto viseme = [&](const std::string& name) {
    for (const GroupScore& one : e.breakdown.visemes)
      if (one.name == name) return one;
    ADD_FAILURE() << name;
    return GroupScore();
  };
  EXPECT_EQ(viseme("10").frames, 1u);
  EXPECT_NEAR(viseme("10").nrmse, 0.2, 1e-9);
  EXPECT_NEAR(viseme("12").nrmse, 0.4, 1e-9);
  EXPECT_TRUE(e.breakdown.triphones.empty());
}

TEST(Breakdown, SeenAndUnseenContexts) {
  std::vector<std::string> labels(36, "AE");
  labels[9] = "AY";
  const auto recorded = [](int, int) { return 0.0; };
  // Wrong only in AY and the AE on both sides of it: 1.0 s to 1.3 s, frames 25 to 32.
  const auto made = [](int, int i) { return i >= 25 && i < 33 ? 30.0 : 0.0; };
  auto pair = pair_of({3}, script_of(labels), recorded, made);
  pair.recorded.script.phones[10].word = "new";
  Utterance training;
  training.script = script_of({"AE", "AE", "AE", "AE"});
  ScoreOptions options;
  options.scale = scale_of({3});
  options.seen = seen_contexts({&training, 1});
  EXPECT_EQ(options.seen.triphones,
            (std::vector<std::string>{"AE AE AE", "AE AE SIL", "SIL AE AE"}));
  EXPECT_EQ(options.seen.words, std::vector<std::string>{"word"});
  const Evaluation e = score_with(pair, options);
  ASSERT_EQ(e.breakdown.triphones.size(), 2u);
  EXPECT_EQ(e.breakdown.triphones[0].phones, 33u);
  EXPECT_EQ(e.breakdown.triphones[0].nrmse, 0);
  EXPECT_EQ(e.breakdown.triphones[1].phones, 3u);
  EXPECT_NEAR(e.breakdown.triphones[1].nrmse, 0.3, 1e-9);
  ASSERT_EQ(e.breakdown.words.size(), 2u);
  EXPECT_EQ(e.breakdown.words[1].phones, 1u);
}

TEST(Score, RefusesWhatDoesNotMatch) {
  const auto value = [](int, int i) { return wave(i); };
  const auto good = pair_of({3}, vowels(), value, value);
  auto bad = good;
  bad.recorded.id = "odd";
  bad.synthesised.values.pop_back();
  auto result = score({&bad, 1});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::invalid_argument);
  EXPECT_THAT(result.error().message, testing::HasSubstr("odd"));
  bad = good;
  bad.synthesised.rate = {30, 1};
  EXPECT_EQ(score({&bad, 1}).error().code, Code::invalid_argument);
  bad = good;
  bad.synthesised.names[0] = "fap4";
  EXPECT_EQ(score({&bad, 1}).error().code, Code::not_found);
  EXPECT_EQ(score({}).error().code, Code::invalid_argument);
  // Pairs that agree in themselves, but not with each other.
  bad = good;
  bad.synthesised.rate = bad.recorded.signal.rate = {30, 1};
  const SentencePair both[] = {good, bad};
  EXPECT_EQ(score(both).error().code, Code::invalid_argument);
}

TEST(Score, WithoutAScaleTheRecordingsAreIt) {
  const auto recorded = [](int, int i) { return i % 2 == 0 ? 30.0 : 10.0; };
  const auto made = [](int, int) { return 20.0; };
  const auto pair = pair_of({3}, vowels(), recorded, made);
  const auto e = score({&pair, 1});
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->nrmse, 1, 1e-9);
  EXPECT_NEAR(e->still_nrmse, 1, 1e-9);
}

TEST(Score, ThreadsDoNotMatter) {
  std::vector<SentencePair> pairs;
  for (int k = 0; k < 9; ++k)
    pairs.push_back(pair_of(
        {3, 4, 5}, with_bilabial(), [k](int fap, int i) { return wave(i + fap + k); },
        [k](int fap, int i) { return wave(i + fap + k + 0.3) * 0.8; }));
  ScoreOptions one, many;
  one.threads = 1;
  many.threads = 7;
  const auto a = score(pairs, one), b = score(pairs, many);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->nrmse, b->nrmse);
  EXPECT_EQ(a->timing.misalignment, b->timing.misalignment);
  EXPECT_EQ(a->timing.all.lag, b->timing.all.lag);
  EXPECT_EQ(a->dynamics.jerk, b->dynamics.jerk);
  EXPECT_GT(a->nrmse, 0);
}

}  // namespace evaluate_measures_test
}  // namespace animeme::dam
