// Half a minute of somebody: what a model of it can say, and what training says about it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dam/script/phones.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace little_test {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// 21 s of recording, 10 s of speech.
std::vector<Utterance> seven() {
  auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
  if (!corpus) return {};
  corpus->utterances.resize(7);
  return corpus->utterances;
}

/// Every sound between two vowels, and beside all sorts of neighbours.
Script all_phones() {
  Script script;
  double t = 0;
  const auto add = [&](std::string_view label, double seconds) {
    script.phones.push_back({t, t + seconds, std::string(label), ""});
    t += seconds;
  };
  add(kSilence, 0.4);
  for (const PhoneInfo& info : phones()) {
    if (info.label == kSilence) continue;
    add(info.label, 0.1);
    add("AH", 0.08);
    add(info.label, 0.12);
  }
  add(kSilence, 0.4);
  return script;
}

TEST(LittleMaterial, SpeaksAllPhonesThroughTies) {
  const auto sentences = seven();
  TrainSummary summary;
  const auto model = train(sentences, {}, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  std::set<std::string> said;
  for (const Utterance& u : sentences)
    for (const Phone& phone : u.script.phones) said.insert(phone.label);
  ASSERT_LT(said.size(), 35u);  // much was never said
  SynthesisReport report;
  const auto signal = synthesise(*model, all_phones(), {}, &report);
  ASSERT_TRUE(signal) << signal.error().describe();
  // Each sound that was never said is named with what is said instead, as training foretold.
  std::set<std::string> replaced;
  for (const auto& [label, by] : report.replaced) {
    replaced.insert(label);
    const auto told = std::find_if(summary.unknown.begin(), summary.unknown.end(),
                                   [&, l = label](const auto& one) { return one.label == l; });
    ASSERT_NE(told, summary.unknown.end()) << label;
    EXPECT_FALSE(told->spoken_as.empty()) << label;
  }
  for (const PhoneInfo& info : phones()) {
    const std::string label(info.label);
    if (label == kSilence) continue;
    EXPECT_NE(said.contains(label), replaced.contains(label)) << label;
  }
  // Sensible: it moves, and stays where this face was seen, within a third of its range.
  for (std::size_t c = 0; c < signal->names.size(); ++c) {
    double low = 1e9, high = -1e9, least = 1e9, most = -1e9;
    for (const Utterance& u : sentences)
      for (std::size_t i = 0; i < u.signal.frames(); ++i) {
        low = std::min(low, u.signal.at(i, c));
        high = std::max(high, u.signal.at(i, c));
      }
    for (std::size_t i = 0; i < signal->frames(); ++i) {
      ASSERT_TRUE(std::isfinite(signal->at(i, c)));
      least = std::min(least, signal->at(i, c));
      most = std::max(most, signal->at(i, c));
    }
    const double margin = (high - low) / 3;
    EXPECT_GT(least, low - margin) << signal->names[c];
    EXPECT_LT(most, high + margin) << signal->names[c];
    EXPECT_GT(most - least, (high - low) / 8) << signal->names[c];
  }
}

TEST(LittleMaterial, IsToldSoWithARemedy) {
  TrainSummary summary;
  ASSERT_TRUE(train(seven(), {}, &summary));
  EXPECT_NEAR(summary.speech_seconds, 12, 3);
  EXPECT_THAT(summary.warnings, Contains(testing::AllOf(HasSubstr("s of speech are too little"),
                                                        HasSubstr("--base builtin"))));
  EXPECT_THAT(summary.warnings, Not(Contains(HasSubstr("the motion comes"))));
  EXPECT_THAT(summary.warnings, Not(Contains(HasSubstr("do not seem to match"))));
}

TEST(LittleMaterial, WhatIsExplainedIsOfSentencesHeldOut) {
  for (const Method method : {Method::dam, Method::triphone}) {
    TrainOptions options;
    options.method = method;
    TrainSummary summary;
    ASSERT_TRUE(train(seven(), options, &summary));
    EXPECT_TRUE(summary.held_out);
    double sum = 0;
    for (const ControlNote& control : summary.controls) sum += control.explained;
    EXPECT_GT(sum / 26, 0.1) << method_name(method);
    EXPECT_LT(sum / 26, 0.65) << method_name(method);  // of the training sentences it is above 0.8
  }
  auto one = seven();
  one.resize(1);
  TrainSummary summary;
  ASSERT_TRUE(train(one, {}, &summary));
  EXPECT_FALSE(summary.held_out);
}

}  // namespace little_test
}  // namespace animeme::dam
