// What every kind of model owes its users, whatever it is made of.
#include "dam/model/kind_internal.h"
#include "dam/training/train.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dam/evaluation/evaluate.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace kinds_test {

using testing::HasSubstr;

class EveryKind : public testing::TestWithParam<Method> {
 protected:
  static TrainOptions quick() {
    TrainOptions options;
    options.method = GetParam();
    options.max_iterations = 3;
    options.animeme.reassign_rounds = 1;
    return options;
  }
  static std::vector<Utterance> sample() {
    const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
    return corpus ? corpus->utterances : std::vector<Utterance>{};
  }
  /// Trains, and sees that the model can be kept and speaks.
  static void expect_usable(const std::vector<Utterance>& sentences, const TrainOptions& options) {
    const auto model = train(sentences, options);
    ASSERT_TRUE(model) << model.error().describe();
    EXPECT_TRUE(validate(*model));
    EXPECT_TRUE(read_model(write_model(*model)));
    const auto signal = synthesise(*model, sentences[0].script);
    ASSERT_TRUE(signal);
    for (const double v : signal->values) EXPECT_TRUE(std::isfinite(v));
  }
};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, testing::ValuesIn(methods().begin(), methods().end()),
                         [](const auto& method) {
                           std::string name(method_name(method.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EveryKind, HasAName) { EXPECT_EQ(find_method(method_name(GetParam())), GetParam()); }

TEST_P(EveryKind, LearnsTheSample) {
  TrainSummary summary;
  const auto sentences = sample();
  const auto model = train(sentences, quick(), &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_TRUE(validate(*model));
  EXPECT_EQ(model->method, GetParam());
  EXPECT_EQ(model->controls.size(), 26u);
  EXPECT_EQ(summary.utterances, 24u);
  EXPECT_TRUE(std::is_sorted(summary.objective.rbegin(), summary.objective.rend()));
  const auto again = read_model(write_model(*model));
  ASSERT_TRUE(again) << again.error().describe();
  EXPECT_EQ(*again, *model);
  EvaluateOptions options;
  options.synthesis.closure = false;
  const auto score = evaluate(*model, sentences, options);
  ASSERT_TRUE(score) << score.error().describe();
  if (GetParam() == Method::mean)
    EXPECT_NEAR(score->nrmse, score->still_nrmse, 0.02);  // long pauses rest
  else
    EXPECT_LT(score->nrmse, 0.8 * score->still_nrmse);  // all know more than a still face
}

TEST_P(EveryKind, ThreadsAndOrderOfSentencesDoNotMatter) {
  auto sentences = sample();
  TrainOptions options = quick();
  options.threads = 1;
  const auto one = train(sentences, options);
  options.threads = 3;
  std::rotate(sentences.begin(), sentences.begin() + 7, sentences.end());
  const auto three = train(sentences, options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(write_model(*one), write_model(*three));
}

TEST_P(EveryKind, AnyFrameRateGivesTheSameCurve) {
  const auto sentences = sample();
  const auto model = train(sentences, quick());
  ASSERT_TRUE(model);
  SynthesisOptions options;
  options.closure = false;
  options.rest_at_ends = false;
  options.sharpness = 0;  // what lies between two frames is not known to it
  const auto slow = synthesise(*model, sentences[5].script, options);
  options.rate = {60, 1};
  const auto fast = synthesise(*model, sentences[5].script, options);
  ASSERT_TRUE(slow && fast);
  for (std::size_t i = 0; 5 * i < slow->frames() && 12 * i < fast->frames(); ++i)
    for (std::size_t c = 0; c < slow->names.size(); ++c)
      EXPECT_NEAR(slow->at(5 * i, c), fast->at(12 * i, c), 1e-6);
}

TEST_P(EveryKind, AWindowOfFramesIsThatOfTheWhole) {
  const auto sentences = sample();
  const auto model = train(sentences, quick());
  ASSERT_TRUE(model);
  const auto timeline = make_timeline(sentences[4].script, model->pause_edge);
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(model->find_phone(o.label));
  const SynthesisOptions options;
  const std::size_t controls = model->controls.size();
  SynthesisReport report;
  const auto speak = [&](std::size_t first, std::size_t frames) {
    std::vector<double> rows(frames * controls, 0.0);
    kind_of(GetParam())
        .speak({*model, timeline, phone, options, {50, 1}, first, frames}, rows, report);
    return rows;
  };
  const auto whole = speak(0, 120), window = speak(40, 30);
  for (std::size_t i = 0; i < window.size(); ++i)
    EXPECT_NEAR(window[i], whole[40 * controls + i], 1e-9);
}

TEST_P(EveryKind, OtherUnitsGiveTheSameMotionInThoseUnits) {
  auto sentences = test::planted(12);
  const auto plain = train(sentences, quick());
  for (Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i) {
      u.signal.at(i, 0) = 1000 * u.signal.at(i, 0) - 30;
      u.signal.at(i, 1) = -0.001 * u.signal.at(i, 1);
    }
  const auto scaled = train(sentences, quick());
  ASSERT_TRUE(plain && scaled);
  const auto a = synthesise(*plain, sentences[0].script);
  const auto b = synthesise(*scaled, sentences[0].script);
  ASSERT_TRUE(a && b);
  const double size = plain->controls[0].sd + plain->controls[1].sd;
  for (std::size_t i = 0; i < a->frames(); ++i) {
    EXPECT_NEAR((b->at(i, 0) + 30) / 1000, a->at(i, 0), 1e-3 * size);
    EXPECT_NEAR(-1000 * b->at(i, 1), a->at(i, 1), 1e-3 * size);
  }
}

TEST_P(EveryKind, CanBeCancelled) {
  int calls = 0;
  const auto model = train(sample(), quick(), nullptr, [&](const Progress&) {
    ++calls;
    return false;
  });
  ASSERT_FALSE(model);
  EXPECT_THAT(model.error().message, HasSubstr("cancelled"));
  EXPECT_EQ(calls, 1);
}

// ---- hostile training data ----

TEST_P(EveryKind, OneSentenceIsEnough) { expect_usable(test::planted(1), quick()); }

TEST_P(EveryKind, ConstantControlsStayConstant) {
  auto sentences = test::planted(4);
  for (Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i) u.signal.at(i, 1) = 0.1;
  TrainSummary summary;
  const auto model = train(sentences, quick(), &summary);
  ASSERT_TRUE(model);
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr("c1")));
  const auto signal = synthesise(*model, sentences[0].script);
  ASSERT_TRUE(signal);
  for (std::size_t i = 0; i < signal->frames(); ++i) EXPECT_NEAR(signal->at(i, 1), 0.1, 1e-12);
}

TEST_P(EveryKind, VeryShortPhonesAndNothingMeasured) {
  auto sentences = test::planted(4);
  for (Utterance& u : sentences) {
    auto& phones = u.script.phones;
    for (std::size_t i = 1; i + 2 < phones.size(); i += 2) {  // one frame and less
      phones[i].end = phones[i].start + 0.002;
      phones[i + 1].start = phones[i].end;
    }
  }
  expect_usable(sentences, quick());
  for (Utterance& u : sentences) u.signal.measured.assign(u.signal.frames(), false);
  expect_usable(sentences, quick());
}

TEST_P(EveryKind, IdenticalSentencesAndNoPrior) {
  auto sentences = test::planted(1);
  for (int i = 0; i < 20; ++i) {
    sentences.push_back(sentences[0]);
    sentences.back().id += std::to_string(i);
  }
  TrainOptions options = quick();
  options.animeme.ridge = 0;
  options.animeme.width_prior = 0;
  options.trajectory.mean_prior = 0;
  options.trajectory.variance_prior = 0;
  options.table.pose_prior = 0;
  options.table.trust = 0;
  expect_usable(sentences, options);
}

}  // namespace kinds_test
}  // namespace animeme::dam
