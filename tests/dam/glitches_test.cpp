// What trackers do wrong, and that models do not mind.
#include "dam/corpus/glitches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/evaluation/evaluate.h"
#include "dam/model/builtin.h"
#include "dam/training/accumulate.h"
#include "dam/training/adapt.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace glitches_test {

using testing::HasSubstr;

/// Seven sentences, 21 s; the others.
struct Little {
  std::vector<Utterance> own, others;
};
const Little& little() {
  static const Little all = [] {
    Little split;
    const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
    for (std::size_t i = 0; corpus && i < corpus->utterances.size(); ++i)
      (i % 3 == 0 && split.own.size() < 7 ? split.own : split.others)
          .push_back(corpus->utterances[i]);
    return split;
  }();
  return all;
}

std::vector<const Utterance*> pointers(const std::vector<Utterance>& sentences) {
  std::vector<const Utterance*> list;
  for (const Utterance& u : sentences) list.push_back(&u);
  return list;
}

double range_of(const std::vector<Utterance>& sentences, std::size_t control) {
  double low = 1e9, high = -1e9;
  for (const Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i) {
      low = std::min(low, u.signal.at(i, control));
      high = std::max(high, u.signal.at(i, control));
    }
  return high - low;
}

/// 0.4 s of nonsense in the jaw, ten times its range; a spike in the lip below; a corner that
/// sticks.
std::vector<Utterance> spoilt(std::vector<Utterance> sentences) {
  test::Uniform random(3);
  const double jaw = 10 * range_of(sentences, 0), lip = 4 * range_of(sentences, 2);
  for (std::size_t i = 30; i < 40; ++i) sentences[2].signal.at(i, 0) = random(-jaw, jaw);
  sentences[4].signal.at(28, 2) += lip;
  for (std::size_t i = 25; i < 45; ++i)
    sentences[5].signal.at(i, 3) = sentences[5].signal.at(25, 3) + 0.25;
  return sentences;
}

double nrmse(const Model& model, const std::vector<Utterance>& sentences,
             const std::vector<Control>& scale) {
  EvaluateOptions options;
  options.score.scale = scale;
  const auto result = evaluate(model, sentences, options);
  EXPECT_TRUE(result);
  return result ? result->nrmse : 9;
}

TEST(Glitches, CleanMaterialIsLeftAlone) {
  const auto all = read_corpus(test::data_dir() / "grid_s1_sample");
  ASSERT_TRUE(all);
  EXPECT_THAT(remove_glitches(pointers(all->utterances)).glitches, testing::IsEmpty());
  EXPECT_THAT(remove_glitches(pointers(little().own)).glitches, testing::IsEmpty());
  for (const Utterance& u : all->utterances) {
    const Utterance* const one[] = {&u};
    EXPECT_THAT(remove_glitches(one).glitches, testing::IsEmpty()) << u.id;
  }
}

TEST(Glitches, AreFoundWithTheirPlaceAndTakenOut) {
  const auto bad = spoilt(little().own);
  const CleanedSentences mended = remove_glitches(pointers(bad));
  const auto found = [&](const std::string& id, const std::string& control) {
    return std::find_if(mended.glitches.begin(), mended.glitches.end(),
                        [&](const Glitch& g) { return g.id == id && g.control == control; });
  };
  const auto jump = found(bad[2].id, "fap3_open_jaw");
  ASSERT_NE(jump, mended.glitches.end());
  EXPECT_EQ(jump->kind, GlitchKind::jump);
  EXPECT_NEAR(double(jump->first), 30, 1);
  EXPECT_NEAR(double(jump->frames), 10, 2);
  EXPECT_FALSE(jump->bridged);
  EXPECT_FALSE(mended.sentences[2]->signal.measured[35]);
  EXPECT_LT(std::abs(mended.sentences[2]->signal.at(35, 0)), range_of(little().own, 0));
  const auto spike = found(bad[4].id, "fap5_raise_b_midlip");
  ASSERT_NE(spike, mended.glitches.end());
  EXPECT_EQ(spike->frames, 1u);
  EXPECT_TRUE(spike->bridged);
  EXPECT_EQ(mended.sentences[4]->signal.measured, little().own[4].signal.measured);
  const auto stuck = found(bad[5].id, "fap6_stretch_l_cornerlip");
  ASSERT_NE(stuck, mended.glitches.end());
  EXPECT_EQ(stuck->kind, GlitchKind::stuck);
  EXPECT_NEAR(double(stuck->frames), 20, 1);
  EXPECT_THAT(describe(*stuck),
              testing::AllOf(HasSubstr("is stuck from 1.0"), HasSubstr("; left out")));
  EXPECT_EQ(mended.sentences[0], &bad[0]);  // borrowed
  const CleanedSentences scored = remove_glitches(pointers(bad), ShortGlitches::omit);
  EXPECT_FALSE(scored.sentences[4]->signal.measured[28]);
}

TEST(Glitches, TheModelIsNearThatOfCleanMaterial) {
  const auto bad = spoilt(little().own);
  TrainSummary summary;
  const auto clean = train(little().own), model = train(bad, {}, &summary);
  ASSERT_TRUE(clean && model);
  const double before = nrmse(*clean, little().others, clean->controls);
  const double after = nrmse(*model, little().others, clean->controls);
  std::printf("NRMSE of other sentences: %.4f, with glitches in training %.4f\n", before, after);
  EXPECT_NEAR(after, before, 0.02);
  for (std::size_t c = 0; c < clean->controls.size(); ++c) {
    EXPECT_NEAR(model->controls[c].mean, clean->controls[c].mean, 0.15 * clean->controls[c].sd);
    EXPECT_NEAR(model->controls[c].sd, clean->controls[c].sd, 0.15 * clean->controls[c].sd);
  }
  EXPECT_GE(summary.glitches.size(), 3u);
  EXPECT_THAT(summary.warnings, testing::Contains(HasSubstr("fap3_open_jaw jumps out of range")));
  auto turned = bad;
  std::reverse(turned.begin(), turned.end());
  TrainOptions one_thread;
  one_thread.threads = 1;
  EXPECT_EQ(*train(turned, one_thread), *model);
}

TEST(Glitches, OtherKindsOfTrainingDoNotMindEither) {
  const auto bad = spoilt(little().own);
  AdaptReport report;
  const auto base = builtin_model();
  const auto clean = adapt(*base, {&little().own[2], 1}),
             model = adapt(*base, {&bad[2], 1}, {}, &report);
  ASSERT_TRUE(clean && model);
  EXPECT_NEAR(nrmse(*model, little().others, base->controls),
              nrmse(*clean, little().others, base->controls), 0.02);
  EXPECT_THAT(report.warnings, testing::Contains(HasSubstr("fap3_open_jaw")));
  // In parts a sentence is judged by itself, so that gross ones are seen.
  auto sums = TrainingSums::start();
  std::vector<Glitch> found;
  for (const Utterance& u : bad) ASSERT_TRUE(sums->add(u, &found));
  EXPECT_THAT(found, testing::Contains(testing::Field(&Glitch::control, "fap3_open_jaw")));
  const auto summed = train_from_sums(std::move(*sums));
  ASSERT_TRUE(summed);
  EXPECT_LT(summed->controls[0].sd, 1.3 * clean->controls[0].sd);
}

TEST(Glitches, AControlThatAlwaysJumpsIsLikeThat) {
  auto sentences = little().own;
  test::Uniform random(5);
  for (Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i)
      if (random(0, 1) < 0.08) u.signal.at(i, 0) = random(-1, 1) * 30000;
  EXPECT_THAT(remove_glitches(pointers(sentences)).glitches,
              testing::Not(testing::Contains(testing::Field(&Glitch::control, "fap3_open_jaw"))));
}

TEST(Glitches, ShapesOfARKitWithinTheirLimitsAreNone) {
  auto sentences = little().own;
  for (Utterance& u : sentences) {
    u.signal.names[0] = "tongueOut";
    for (std::size_t i = 0; i < u.signal.frames(); ++i) u.signal.at(i, 0) = 0;
  }
  sentences[1].signal.at(40, 0) = 0.9;
  sentences[1].signal.at(41, 0) = 1;
  EXPECT_THAT(remove_glitches(pointers(sentences)).glitches, testing::IsEmpty());
}

TEST(Glitches, WhatIsNoSignalIsHandedOn) {
  EXPECT_TRUE(remove_glitches({}).sentences.empty());
  auto sentences = little().own;
  sentences[1].signal.at(3, 0) = std::nan("");
  EXPECT_EQ(remove_glitches(pointers(sentences)).sentences[1], &sentences[1]);
  sentences = little().own;
  sentences[1].signal.names.pop_back();
  EXPECT_EQ(remove_glitches(pointers(sentences)).sentences[1], &sentences[1]);
}

}  // namespace glitches_test
}  // namespace animeme::dam
