#include "dam/train.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dam/synthesise.h"
#include "dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace {

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
  options.animeme.preference = 1;  // so few sentences have one mode a phone otherwise
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
  test::Random random(9);
  const auto truth = test::plant(random, {"SIL", "AA", "B", "IY", "S"}, 3, 3);
  auto sentences = test::planted_sentences(random, truth, 30);
  TrainSummary summary;
  TrainOptions options;
  options.animeme.modes = false;
  ASSERT_TRUE(train(sentences, options, &summary));
  EXPECT_LT(std::abs(summary.lag), 0.02);
  EXPECT_THAT(summary.warnings, testing::Not(testing::Contains(HasSubstr("ms after"))));
  for (Utterance& u : sentences) {  // the face 80 ms late
    auto& values = u.signal.values;
    values.insert(values.begin(), 4 * 3, 0.0);
    values.resize(values.size() - 4 * 3);
  }
  ASSERT_TRUE(train(sentences, options, &summary));
  EXPECT_GT(summary.lag, 0.05);  // the direction is sure, the amount is rough
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr("ms after")));
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

std::vector<Utterance> planted(std::size_t count) {
  test::Random random(5);
  const auto truth = test::plant(random, {"SIL", "AA", "B", "IY"}, 2, 2);
  return test::planted_sentences(random, truth, count);
}

std::string refusal(const std::vector<Utterance>& sentences) {
  const auto model = train(sentences);
  EXPECT_FALSE(model);
  return model ? "" : model.error().message;
}

TEST(TrainHostile, NothingToLearnFrom) {
  EXPECT_THAT(refusal({}), HasSubstr("no sentence"));
  auto silent = planted(2);
  for (Utterance& u : silent) u.script.phones = {{0, 2, "SIL", ""}};
  EXPECT_THAT(refusal(silent), HasSubstr("silence"));
}

TEST(TrainHostile, BrokenSignals) {
  auto sentences = planted(3);
  sentences[1].signal.at(7, 1) = std::nan("");
  EXPECT_THAT(refusal(sentences), HasSubstr("frame 7 of c1"));
  sentences = planted(3);
  sentences[2].signal.names[0] = "other";
  EXPECT_THAT(refusal(sentences), HasSubstr("s102"));
  sentences = planted(3);
  sentences[0].signal.values.clear();
  EXPECT_THAT(refusal(sentences), HasSubstr("empty"));
  sentences = planted(3);
  sentences[1].signal.rate = {30, 1};
  EXPECT_THAT(refusal(sentences), HasSubstr("rate"));
  sentences = planted(3);
  sentences[1].script.phones[2].end = sentences[1].script.phones[2].start;
  EXPECT_THAT(refusal(sentences), HasSubstr("s101"));
}

TEST(TrainHostile, OneSentenceIsWarnedOf) {
  TrainSummary summary;
  const auto model = train(planted(1), {}, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_FALSE(summary.warnings.empty());
}

}  // namespace
}  // namespace animeme::dam
