#include "dam/signal/gain_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dam/model/builtin.h"
#include "dam/model/rescale.h"
#include "dam/speaking/poses.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace gain_offset_test {

using ::testing::HasSubstr;

constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();

TEST(GainOffset, FindsWhatPosesWereMadeWith) {
  // jaw and lip are moved by the poses, brow is not, snout is not in the second table, ear has no
  // pose.
  const Poses from{{"jaw", "lip", "brow", "snout", "ear"},
                   {"rest", "AA", "UW"},
                   {0.1, 5, 2, 1, 0,  //
                    0.9, 5, 2, 3, 1,  //
                    0.3, 25, 2, 2, 0}};
  const Poses to{{"ear", "brow", "lip", "jaw", "nose"},
                 {"uw", "Neutral", "aa", "IY"},
                 {kBlank, 7, 2,  13,  1,  //
                  kBlank, 7, 42, 11,  1,  //
                  kBlank, 7, 42, 19,  1,  //
                  9,      7, 42, 100, 1}};
  const auto gains = fit_gain_offset(from, to);
  ASSERT_TRUE(gains) << gains.error().describe();
  ASSERT_EQ(gains->size(), 5u);
  EXPECT_NEAR((*gains)[0].gain, 10, 1e-12);
  EXPECT_NEAR((*gains)[0].offset, 10, 1e-12);
  EXPECT_NEAR((*gains)[0].residual, 0, 1e-12);
  EXPECT_EQ((*gains)[0].poses, 3u);
  EXPECT_EQ((*gains)[0].source, GainSource::poses);
  EXPECT_NEAR((*gains)[1].gain, -2, 1e-12) << "it goes the other way";
  EXPECT_NEAR((*gains)[1].offset, 52, 1e-12);
  EXPECT_EQ((*gains)[2].source, GainSource::others);
  EXPECT_NEAR((*gains)[2].gain, 4, 1e-12) << "between 10 and -2";
  EXPECT_NEAR((*gains)[2].gain * 2 + (*gains)[2].offset, 7, 1e-12) << "rest is met";
  for (const std::size_t same : {3u, 4u}) {
    EXPECT_EQ((*gains)[same].source, GainSource::none);
    EXPECT_EQ((*gains)[same].gain, 1);
    EXPECT_EQ((*gains)[same].offset, 0);
  }
}

TEST(GainOffset, RestIsMetAndTheOthersAsNearAsTheyCan) {
  const Poses from{{"jaw"}, {"rest", "a", "b"}, {0, 1, 2}};
  const Poses to{{"jaw"}, {"rest", "a", "b"}, {5, 6, 9}};
  const auto gains = fit_gain_offset(from, to);
  ASSERT_TRUE(gains);
  EXPECT_NEAR((*gains)[0].offset, 5, 1e-12);
  EXPECT_NEAR((*gains)[0].gain, (1 * 1 + 2 * 4) / 5.0, 1e-12);
  EXPECT_NEAR((*gains)[0].residual, std::sqrt((0.64 + 0.16) / 3), 1e-12);
  // Without it both are free: the line through two poses.
  const auto line = fit_gain_offset({{"jaw"}, {"a", "b"}, {1, 2}}, {{"jaw"}, {"a", "b"}, {6, 9}});
  ASSERT_TRUE(line);
  EXPECT_NEAR((*line)[0].gain, 3, 1e-12);
  EXPECT_NEAR((*line)[0].offset, 3, 1e-12);
}

TEST(GainOffset, SaysWhatIsWrong) {
  const Poses one{{"jaw"}, {"rest", "a"}, {0, 1}};
  const auto message = [](const Poses& from, const Poses& to) {
    const auto gains = fit_gain_offset(from, to);
    return gains ? std::string("fine") : gains.error().message;
  };
  EXPECT_THAT(message(one, {{"lip"}, {"a"}, {1}}), HasSubstr("no control in common"));
  EXPECT_THAT(message(one, {{"jaw"}, {"b"}, {1}}), HasSubstr("the gains cannot be determined"));
  EXPECT_THAT(message({{"jaw"}, {"rest", "a"}, {1, 1}}, one),
              HasSubstr("the gains cannot be determined"));
  EXPECT_THAT(message(one, {{"jaw"}, {"a", "A"}, {1, 2}}), HasSubstr("A twice"));
  EXPECT_THAT(message(one, {{"jaw", "jaw"}, {"a"}, {1, 2}}), HasSubstr("jaw twice"));
  EXPECT_THAT(message(one, {{"jaw"}, {"a"}, {1, 2}}), HasSubstr("number of values"));
  EXPECT_THAT(message(one, {{"jaw"}, {"a"}, {INFINITY}}), HasSubstr("beyond 1e100"));
}

Script sentence() {
  Script script;
  double t = 0;
  for (const char* label : {"SIL", "M", "AA", "F", "UW", "P", "IY", "SIL"}) {
    script.phones.push_back({t, t + 0.15, label, ""});
    t += 0.15;
  }
  return script;
}

/// Every method speaks gain * value + offset, also where a control goes the other way.
TEST(Rescale, SpeaksAsTheOtherFace) {
  const auto builtin = builtin_model();
  ASSERT_TRUE(builtin);
  std::vector<Model> models = {*builtin};
  for (const Method method : {Method::dam_paper, Method::mmm, Method::viseme, Method::triphone,
                              Method::mean, Method::cohen_massaro}) {
    test::Uniform random(3);
    std::vector<Utterance> sentences;
    for (int i = 0; i < 4; ++i) {
      Utterance& one = sentences.emplace_back();
      one.id = std::to_string(i);
      one.script = test::random_script(random, {"M", "AA", "F", "UW", "P", "IY"}, 12);
      const auto signal = synthesise(*builtin, one.script);
      ASSERT_TRUE(signal);
      one.signal = *signal;
    }
    TrainOptions options;
    options.method = method;
    options.animeme.affinity_iterations = 20;
    const auto model = train(sentences, options);
    ASSERT_TRUE(model) << model.error().describe();
    models.push_back(*model);
  }
  for (const Model& model : models) {
    std::vector<GainOffset> gains(model.controls.size());
    for (std::size_t c = 0; c < gains.size(); ++c) {
      gains[c].gain = c % 3 == 0 ? -0.5 : 1.25;
      gains[c].offset = double(c);
    }
    Model other = model;
    ASSERT_TRUE(rescale(other, gains));
    ASSERT_TRUE(validate(other)) << validate(other).error().describe();
    SynthesisOptions options;
    options.closure = false;
    const auto before = synthesise(model, sentence(), options);
    const auto after = synthesise(other, sentence(), options);
    ASSERT_TRUE(before && after);
    Signal wanted = *before;
    apply_gain_offset(wanted, gains);
    double off = 0, size = 0;
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
      off = std::max(off, std::abs(after->values[i] - wanted.values[i]));
      size = std::max(size, std::abs(wanted.values[i]));
    }
    EXPECT_GT(size, 10) << method_name(model.method);
    EXPECT_LT(off, 1e-5 * size) << method_name(model.method);
  }
}

TEST(Rescale, BoundsGoAlongButThoseOfArkitStay) {
  auto model = builtin_model();
  ASSERT_TRUE(model);
  model->controls[0].name = "jawOpen";
  const std::size_t count = model->controls.size();
  model->limits.assign(count, {});
  model->limits[0] = {0, 1, -1, 0};
  model->limits[1] = {-10, 20, 2, 3};
  model->limits[2] = {-10, 20, 1, 3};
  model->limits[3] = {-1, 2, -1, 0};
  std::vector<GainOffset> gains(count);
  for (std::size_t c = 0; c < 4; ++c) gains[c].gain = c == 3 ? -2 : 2;
  gains[3].offset = 1;
  ASSERT_TRUE(rescale(*model, gains));
  EXPECT_EQ(model->limits[0], (ControlLimit{0, 1, -1, 0}));
  EXPECT_EQ(model->limits[1], (ControlLimit{-20, 40, 2, 6}));
  EXPECT_EQ(model->limits[2], (ControlLimit{-20, 40, 1, 6}));
  EXPECT_EQ(model->limits[3], (ControlLimit{-3, 3, -1, 0}));
  gains[1].offset = 1;
  ASSERT_TRUE(rescale(*model, gains));
  EXPECT_EQ(model->limits[1].opposite, -1) << "with an offset nothing says that they undo";
  gains.pop_back();
  EXPECT_FALSE(rescale(*model, gains));
}

TEST(PosesOfModel, AreWhatItShows) {
  const auto model = builtin_model();
  ASSERT_TRUE(model);
  const auto poses = poses_of(*model, std::vector<std::string>{"Rest", "aa", "M", "UW"});
  ASSERT_TRUE(poses) << poses.error().describe();
  ASSERT_EQ(poses->values.size(), 4 * model->controls.size());
  const auto jaw = std::size_t(model->find_control("fap3_open_jaw"));
  EXPECT_EQ(poses->at(0, jaw), model->controls[jaw].rest);
  EXPECT_GT(poses->at(1, jaw), poses->at(0, jaw) + 50);
  const auto lips = inner_lip_channels(poses->names);
  ASSERT_TRUE(lips);
  EXPECT_LE(-(poses->at(2, lips->upper) + poses->at(2, lips->lower)), 30) << "M is closed";
  const auto wrong = poses_of(*model, std::vector<std::string>{"smile"});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("'smile' is not a phone"));
}

}  // namespace gain_offset_test
}  // namespace animeme::dam
