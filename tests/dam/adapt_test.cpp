#include "dam/training/adapt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace adapt_test {

const std::vector<std::string> kAlphabet = {"AA", "IY", "M", "T", "UW", "S"};

/// Sentences of somebody whose controls follow planted curves: control c is gain[c] times planted
/// control from[c], plus an offset.
struct Speaker {
  std::vector<std::string> names;
  std::vector<std::size_t> from;
  std::vector<double> gain;
  double offset = 0;
};

std::vector<Utterance> sentences(const Speaker& speaker, std::size_t count, std::uint32_t seed,
                                 const std::vector<std::string>& alphabet = kAlphabet) {
  test::Uniform fixed(11);  // the same curves for everybody
  const test::Planted planted = test::plant(fixed, {"AA", "IY", "M", "S", "SIL", "T", "UW"}, 3, 3);
  test::Uniform random(seed);
  std::vector<Utterance> all;
  for (std::size_t i = 0; i < count; ++i) {
    Utterance u;
    u.id = "s" + std::to_string(i);
    u.script = test::random_script(random, alphabet, 14);
    const Signal signal = test::planted_signal(planted, u.script, 0.3, 0.5, true);
    u.signal.rate = signal.rate;
    u.signal.names = speaker.names;
    for (std::size_t f = 0; f < signal.frames(); ++f)
      for (std::size_t c = 0; c < speaker.names.size(); ++c)
        u.signal.values.push_back(speaker.offset + speaker.gain[c] * signal.at(f, speaker.from[c]));
    all.push_back(std::move(u));
  }
  return all;
}

/// Error of a model on sentences, as a share of the variance of all controls.
double error_of(const Model& model, const std::vector<Utterance>& all) {
  double error = 0, energy = 0, mean = 0, count = 0;
  for (const Utterance& u : all)
    for (const double value : u.signal.values) {
      mean += value;
      count += 1;
    }
  mean /= count;
  for (const Utterance& u : all) {
    SynthesisOptions options;
    options.rate = u.signal.rate;
    options.frames = u.signal.frames();
    const auto made = synthesise(model, u.script, options);
    EXPECT_TRUE(made);
    if (!made) return 1;
    for (std::size_t i = 0; i < u.signal.values.size(); ++i) {
      error += std::pow(made->values[i] - u.signal.values[i], 2);
      energy += std::pow(u.signal.values[i] - mean, 2);
    }
  }
  return error / energy;
}

const Speaker kBase = {{"a", "b", "c"}, {0, 1, 2}, {1, 1, 1}, 0};

const Model& base() {
  static const Model model = *train(sentences(kBase, 60, 1));
  return model;
}

TEST(Adapt, OtherGainsAndOffsetsAreLearnedFromTwoSentences) {
  const Speaker own = {{"c", "a"}, {2, 0}, {0.5, 1.8}, 0.7};
  AdaptReport report;
  const auto model = adapt(base(), sentences(own, 2, 5), {}, &report);
  ASSERT_TRUE(model) << model.error().describe();
  ASSERT_EQ(report.controls.size(), 2u);
  EXPECT_TRUE(report.controls[0].same_name);
  EXPECT_NEAR(report.controls[0].gain, 0.5, 0.12);
  EXPECT_NEAR(report.controls[1].gain, 1.8, 0.2);
  EXPECT_EQ(report.sentences, 2u);
  const auto test = sentences(own, 10, 99);
  const auto alone = train(sentences(own, 2, 5));
  ASSERT_TRUE(alone);
  const double adapted = error_of(*model, test);
  EXPECT_LT(adapted, 0.15);
  EXPECT_LT(adapted, 0.75 * error_of(*alone, test));
}

TEST(Adapt, ControlsOfAnotherRigAreMixed) {
  const Speaker own = {{"jawOpen", "x"}, {1, 2}, {-0.3, 2}, 0.1};
  AdaptReport report;
  const auto model = adapt(base(), sentences(own, 6, 5), {}, &report);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_FALSE(report.controls[0].same_name);
  EXPECT_GT(report.controls[0].base, 0.8);
  EXPECT_LT(error_of(*model, sentences(own, 10, 99)), 0.2);
}

TEST(Adapt, WhatTheBaseDoesNotTellIsLearned) {
  // Controls a and c change places: gains cannot tell that.
  const Speaker own = {{"a", "b", "c"}, {2, 1, 0}, {1, 1, 1}, 0};
  AdaptReport report;
  const auto model = adapt(base(), sentences(own, 20, 5), {}, &report);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_TRUE(report.ridge > 0 || report.base_share < 0.5);
  EXPECT_LT(report.error.nrmse, 0.8 * report.base_error.nrmse);
  EXPECT_GT(report.own_error.nrmse, 0);
  EXPECT_LT(report.own_error.nrmse, report.still_error.nrmse);
  EXPECT_LT(error_of(*model, sentences(own, 10, 99)), 0.25);
}

/// The middle of the gaps between the inner lips over frames of speech.
double median_gap(const Signal& signal, const Script& script) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i < signal.frames(); ++i)
    for (const Phone& phone : script.phones)
      if (phone.label != kSilence && phone.start <= signal.time(i) && signal.time(i) < phone.end)
        gaps.push_back(-(signal.at(i, 0) + signal.at(i, 1)));
  std::nth_element(gaps.begin(), gaps.begin() + std::ptrdiff_t(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2];
}

TEST(Adapt, LipsThatAreApartAtRestAreClosedThereAndNotInSpeech) {
  // Lips, which a rest closes, of somebody whose lips are 400 units apart in silence and more in
  // speech. The base rests elsewhere.
  const std::vector<std::string> lips = {"fap4_lower_t_midlip", "fap5_raise_b_midlip"};
  const auto base_of_lips = train(sentences({lips, {0, 1}, {60, 90}, -20}, 60, 1));
  ASSERT_TRUE(base_of_lips);
  for (const std::size_t count : {1, 2, 8}) {
    const Speaker own = {lips, {0, 1}, {90, 120}, -200};
    const auto model = adapt(*base_of_lips, sentences(own, count, 5));
    ASSERT_TRUE(model) << model.error().describe();
    EXPECT_NEAR(model->controls[0].rest + model->controls[1].rest, 0, 30) << "closed";
    double made = 0, recorded = 0;
    for (const Utterance& u : sentences(own, 10, 99)) {
      SynthesisOptions options;
      options.rate = u.signal.rate;
      options.frames = u.signal.frames();
      options.closure = false;
      const auto signal = synthesise(*model, u.script, options);
      ASSERT_TRUE(signal);
      made += median_gap(*signal, u.script) / 10;
      recorded += median_gap(u.signal, u.script) / 10;
      EXPECT_LT(std::abs(signal->at(0, 0) + signal->at(0, 1)), 30) << "the first frame rests";
    }
    EXPECT_NEAR(made, recorded, 0.15 * recorded) << count << " sentences";
    EXPECT_GT(recorded, 300);
  }
}

TEST(Adapt, IsNotWorseThanItsIngredientsByMuch) {
  // Somebody who has nothing in common with the base, and somebody who is the base.
  const Speaker other = {{"a", "b", "c"}, {1, 2, 0}, {-1, 1, -1}, 3};
  AdaptReport report;
  const auto own = sentences(other, 12, 5);
  const auto model = adapt(base(), own, {}, &report);
  ASSERT_TRUE(model);
  const auto test = sentences(other, 10, 99);
  EXPECT_LT(error_of(*model, test), error_of(*train(own), test) + 0.02);
  EXPECT_LE(report.error.nrmse, report.own_error.nrmse + 0.01);
  EXPECT_LE(report.error.nrmse, report.base_error.nrmse + 0.01);
  const auto same = adapt(base(), sentences(kBase, 4, 5), {}, &report);
  ASSERT_TRUE(same);
  EXPECT_GT(report.base_share, 0.4);
  EXPECT_LT(error_of(*same, sentences(kBase, 10, 99)),
            error_of(base(), sentences(kBase, 10, 99)) + 0.05);
}

TEST(Adapt, SaysSoIfNothingHelps) {
  // Motion that has nothing to do with the scripts: no model beats a still face.
  auto own = sentences(kBase, 8, 5);
  test::Uniform random(3);
  for (Utterance& u : own)
    for (double& value : u.signal.values) value = random(-1, 1);
  AdaptReport report;
  ASSERT_TRUE(adapt(base(), own, {}, &report));
  EXPECT_THAT(report.warnings, testing::Contains(testing::HasSubstr("than a still face")));
}

TEST(Adapt, PhonesThatWereNeverSaidAreSpokenAsTheBaseDoes) {
  const Speaker own = {{"a", "b", "c"}, {0, 1, 2}, {1.4, 1.4, 1.4}, 0};
  const auto few = sentences(own, 4, 5, {"AA", "T"});
  const auto model = adapt(base(), few);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_EQ(model->phones.size(), base().phones.size());
  EXPECT_LT(error_of(*model, sentences(own, 10, 99)), 0.25);
}

TEST(Adapt, IsTheSameInAnyOrderAndIsWrittenAndRead) {
  const Speaker own = {{"a", "c"}, {0, 2}, {0.9, 1.2}, 0.2};
  auto some = sentences(own, 5, 5);
  const auto one = adapt(base(), some);
  std::reverse(some.begin(), some.end());
  const auto other = adapt(base(), some);
  ASSERT_TRUE(one);
  ASSERT_TRUE(other);
  EXPECT_EQ(*one, *other);
  const auto read = read_model(write_model(*one));
  ASSERT_TRUE(read) << read.error().describe();
  EXPECT_EQ(*read, *one);
}

TEST(Adapt, OneSentenceWillDo) {
  const Speaker own = {{"a"}, {0}, {2}, 0};
  AdaptReport report;
  ASSERT_TRUE(adapt(base(), sentences(own, 1, 5), {}, &report));
  EXPECT_EQ(report.error.nrmse, 0);
  EXPECT_EQ(report.base_share, 0.5);
}

TEST(Adapt, RefusesWhatDoesNotFit) {
  const Speaker own = {{"a"}, {0}, {1}, 0};
  EXPECT_EQ(adapt(base(), {}).error().code, Code::invalid_argument);
  TrainOptions other;
  other.method = Method::viseme;
  const auto viseme = train(sentences(kBase, 5, 1), other);
  ASSERT_TRUE(viseme);
  const auto refused = adapt(*viseme, sentences(own, 2, 5));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("method dam, this one is of viseme"));
  auto bad = sentences(own, 2, 5);
  bad[1].signal.values[3] = std::nan("");
  EXPECT_THAT(adapt(base(), bad).error().message,
              testing::HasSubstr("'s1' has a value that is not finite"));
  bad = sentences(own, 2, 5);
  bad[1].signal.names[0] = "b";
  EXPECT_THAT(adapt(base(), bad).error().message, testing::HasSubstr("other controls"));
  const auto cancelled =
      adapt(base(), sentences(own, 4, 5), {}, nullptr, [](const Progress&) { return false; });
  EXPECT_FALSE(cancelled);
}

}  // namespace adapt_test
}  // namespace animeme::dam
