#include "dam/training/train.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dam/speaking/synthesise.h"
#include "dam/training/alignment.h"
#include "tests/dam/dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace train_test {

using testing::HasSubstr;

std::vector<Utterance> sample() {
  const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
  return corpus ? corpus->utterances : std::vector<Utterance>{};
}

const AnimemeParameters& animemes(const Model& model) {
  return std::get<AnimemeParameters>(model.parameters);
}

TrainOptions quick() {
  TrainOptions options;
  options.method = Method::dam_paper;
  options.max_iterations = 3;
  options.animeme.reassign_rounds = 1;
  return options;
}

TEST(Train, TheSampleGivesAValidModel) {
  TrainSummary summary;
  TrainOptions options = quick();
  options.animeme.preference = 1;  // so few sentences have one mode per phone otherwise
  const auto model = train(sample(), options, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_TRUE(validate(*model));
  EXPECT_EQ(model->controls.size(), 26u);
  EXPECT_GT(summary.modes, model->phones.size());  // some phones have several
  EXPECT_EQ(summary.utterances, 24u);
  EXPECT_EQ(summary.objective.size(), std::size_t(summary.iterations) + 1);
  EXPECT_TRUE(std::is_sorted(summary.objective.rbegin(), summary.objective.rend()));
  EXPECT_THAT(summary.warnings,
              testing::Contains(testing::AllOf(HasSubstr("few examples"), HasSubstr("AA "))));
}

TEST(Train, EveryOrderOfThePolynomialWorks) {
  for (const int order : {0, 1, 8}) {
    TrainOptions options = quick();
    options.animeme.order = order;
    const auto model = train(sample(), options);
    ASSERT_TRUE(model) << order;
    EXPECT_EQ(animemes(*model).phones[0].modes[0].coefficients.size(), std::size_t(order + 1) * 26);
  }
}

TEST(Train, FreeExtrapolationCanBeChosen) {
  TrainOptions options = quick();
  options.animeme.time_margin = std::numeric_limits<double>::infinity();
  const auto model = train(sample(), options);
  ASSERT_TRUE(model);
  EXPECT_TRUE(std::isinf(animemes(*model).time_margin));
  EXPECT_TRUE(synthesise(*model, sample()[0].script));
}

TEST(Train, CanBeCancelled) {
  int calls = 0;
  const auto model =
      train(sample(), quick(), nullptr, [&](const Progress&) { return ++calls < 2; });
  ASSERT_FALSE(model);
  EXPECT_THAT(model.error().message, HasSubstr("cancelled"));
  EXPECT_EQ(calls, 2);
}

TEST(Train, NoticesWhenSoundAndFaceAreApart) {
  TrainSummary summary;
  auto sentences = sample();
  ASSERT_TRUE(train(sentences, quick(), &summary));
  EXPECT_THAT(summary.warnings, testing::Not(testing::Contains(HasSubstr("the motion comes"))));
  for (Utterance& u : sentences) u.script = shifted_script(u.script, -0.16);
  ASSERT_TRUE(train(sentences, quick(), &summary));
  ASSERT_TRUE(summary.alignment.lag);
  EXPECT_NEAR(summary.alignment.lag->seconds, 0.16, 0.02);
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr(" ms after the sound (95 %: +1")));
  for (Utterance& u : sentences) u.script = shifted_script(u.script, 0.28);
  ASSERT_TRUE(train(sentences, quick(), &summary));
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr(" ms before the sound (95 %: -1")));
}

// ---- what it says about the data ----

TEST(TrainNotes, PhonesLeanOnTheirClassAndOnRelatives) {
  TrainSummary summary;
  ASSERT_TRUE(train(sample(), {}, &summary));
  const auto rare = std::find_if(summary.rare.begin(), summary.rare.end(),
                                 [](const RarePhone& p) { return p.label == "M"; });
  ASSERT_NE(rare, summary.rare.end());
  EXPECT_EQ(rare->examples, 3u);
  EXPECT_THAT(rare->leans_on, testing::ElementsAre("B", "P"));
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr("M 3 (leans on B P)")));
  const auto spoken = [&](const std::string& label) {
    for (const UnknownPhone& p : summary.unknown)
      if (p.label == label) return p.spoken_as;
    return std::string("known");
  };
  EXPECT_EQ(spoken("NG"), "the vowel before");
  EXPECT_EQ(spoken("HH"), "the next vowel");
  EXPECT_EQ(spoken("B"), "known");
}

/// Sentences that a model of method dam fits well.
std::vector<Utterance> clean(std::size_t count) {
  test::Uniform random(9);
  const auto truth = test::plant(random, {"SIL", "AA", "B", "IY", "S"}, 3, 3);
  return test::planted_sentences(random, truth, count);
}

TEST(TrainNotes, AControlOfNoiseIsNamed) {
  auto sentences = clean(32);
  test::Uniform random(4);
  for (Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i) u.signal.at(i, 1) = random(-1, 1);
  TrainSummary summary;
  ASSERT_TRUE(train(sentences, {}, &summary));
  EXPECT_TRUE(summary.held_out);
  ASSERT_EQ(summary.controls.size(), 3u);
  EXPECT_GT(summary.controls[0].explained, 0.7);
  EXPECT_LT(summary.controls[1].explained, kNoise);
  EXPECT_LE(summary.controls[2].explained, 1);
  EXPECT_THAT(summary.warnings, testing::Contains(testing::AllOf(HasSubstr("may be noise: c1"),
                                                                 testing::Not(HasSubstr("c0")))));
}

TEST(TrainNotes, SentencesThatStandOutAreNamed) {
  for (const Method method : methods()) {
    TrainOptions options;
    options.method = method;
    auto sentences = clean(32);
    TrainSummary summary;
    ASSERT_TRUE(train(sentences, options, &summary));
    const std::size_t before = summary.outliers.size();
    for (double& v : sentences[5].signal.values) v += 2;    // off as a whole
    std::swap(sentences[11].script, sentences[20].script);  // the labels of another one
    ASSERT_TRUE(train(sentences, options, &summary)) << method_name(method);
    std::vector<std::string> named;
    for (const SentenceNote& s : summary.outliers) named.push_back(s.id);
    EXPECT_LE(named.size(), 3u);
    EXPECT_THAT(named, testing::Contains("s105")) << method_name(method);
    if (method == Method::dam) {  // the others have more errors of their own
      EXPECT_THAT(named, testing::Contains(testing::AnyOf("s111", "s120")));
    }
    EXPECT_LT(before, 3u);
    EXPECT_GT(summary.outliers[0].offset, kOutlierOffset);
    EXPECT_EQ(summary.outliers[0].id, "s105");
    EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr("outlier sentences")));
  }
}

TEST(Train, OptionsAreChecked) {
  const auto refused = [](auto change) {
    TrainOptions options;
    change(options);
    return !validate(options);
  };
  EXPECT_TRUE(validate(TrainOptions{}));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.animeme.order = 9; }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.animeme.ridge = -1; }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.animeme.ridge = std::nan(""); }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.animeme.damping = 1; }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.animeme.resample_points = 1; }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.threads = -1; }));
  EXPECT_TRUE(refused([](TrainOptions& o) { o.method = Method(99); }));
}

// ---- hostile training data ----

std::string refusal(const std::vector<Utterance>& sentences) {
  const auto model = train(sentences);
  EXPECT_FALSE(model);
  return model ? "" : model.error().message;
}

TEST(TrainHostile, NothingToLearnFrom) {
  EXPECT_THAT(refusal({}), HasSubstr("no sentence"));
  auto silent = test::planted(2);
  for (Utterance& u : silent) u.script.phones = {{0, 2, "SIL", ""}};
  EXPECT_THAT(refusal(silent), HasSubstr("silence"));
}

TEST(TrainHostile, BrokenSignals) {
  auto sentences = test::planted(3);
  sentences[1].signal.at(7, 1) = std::nan("");
  EXPECT_THAT(refusal(sentences), HasSubstr("frame 7 of c1"));
  sentences = test::planted(3);
  sentences[2].signal.names[0] = "other";
  EXPECT_THAT(refusal(sentences), HasSubstr("s102"));
  sentences = test::planted(3);
  sentences[0].signal.values.clear();
  EXPECT_THAT(refusal(sentences), HasSubstr("empty"));
  sentences = test::planted(3);
  sentences[1].signal.rate = {30, 1};
  EXPECT_THAT(refusal(sentences), HasSubstr("rate"));
  sentences = test::planted(3);
  sentences[1].script.phones[2].end = sentences[1].script.phones[2].start;
  EXPECT_THAT(refusal(sentences), HasSubstr("s101"));
}

TEST(TrainHostile, OneSentenceIsWarnedOf) {
  TrainSummary summary;
  const auto model = train(test::planted(1), {}, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_FALSE(summary.warnings.empty());
}

}  // namespace train_test
}  // namespace animeme::dam
