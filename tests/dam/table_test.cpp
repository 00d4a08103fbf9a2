// Poses and curves from tables: what was planted is found, and the back-off goes as it should.
#include <gtest/gtest.h>

#include <cmath>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/table/contexts.h"
#include "dam/kinds/table/viseme_weights.h"
#include "dam/model/kind_internal.h"
#include "dam/speaking/synthesise.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace table_test {

Model model_of(Method method, Parameters parameters) {
  Model model;
  model.method = method;
  model.controls = {{"c0", 0, 0, 1}};
  // Class 1: B and P; class 8: AA; class 0: SIL.
  model.phones = {{"AA", 9, 8}, {"B", 9, 1}, {"P", 9, 1}, {"SIL", 9, 0}};
  model.parameters = std::move(parameters);
  return model;
}

/// One value a frame, at 100 frames per second.
std::vector<double> spoken(const Model& model, const std::vector<Occurrence>& timeline,
                           std::size_t frames) {
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(model.find_phone(o.label));
  std::vector<double> rows(frames, 0.0);
  const SynthesisOptions options;
  SynthesisReport report;
  kind_of(model.method).speak({model, timeline, phone, options, {100, 1}, 0, frames}, rows, report);
  return rows;
}

TEST(Mean, IsTheMeanPose) {
  Model model = model_of(Method::mean, MeanParameters{});
  model.controls = {{"c0", 10, 16, 3}};
  for (const double v : spoken(model, {}, 20)) EXPECT_DOUBLE_EQ(v, 2);
}

TEST(Viseme, HoldsAndStraightLines) {
  const Model model = model_of(Method::viseme, VisemeParameters{0.5, 0.5, {1, 3, 0, -1}});
  ASSERT_TRUE(validate(model));
  // AA is held from 0.1 to 0.3 s, B from 0.45 to 0.55 s.
  const auto v = spoken(model, {{"AA", 0, 0.4, "", "B"}, {"B", 0.4, 0.2, "AA", ""}}, 60);
  EXPECT_DOUBLE_EQ(v[0], 1);
  EXPECT_NEAR(v[30], 1, 1e-9);
  EXPECT_NEAR(v[36], 1 + 2 * 0.06 / 0.15, 1e-9);
  EXPECT_NEAR(v[45], 3, 1e-9);
  EXPECT_DOUBLE_EQ(v[59], 3);
}

TEST(Viseme, TrainingFindsPosesAndTheirPlace) {
  test::Uniform random(3);
  const std::vector<double> poses = {1, -2, 0.5, 0};
  TrainingSet set;
  set.data.controls = 1;
  set.data.rate = 100;
  for (int s = 0; s < 10; ++s) {
    FitSentence sentence{set.data.use.size(), 200, set.data.occurrences.size(), 14};
    double t = 0;
    for (std::size_t j = 0; j < sentence.occurrences; ++j) {
      const double duration = random(0.1, 0.18);
      set.data.occurrences.push_back({t, duration, std::int32_t(random.below(4)), 0, 0, 0});
      t += duration;
    }
    std::size_t near = 0;
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const FitOccurrence* list = &set.data.occurrences[sentence.first_occurrence];
      const auto hold = [&](std::size_t j) {
        return hold_of(list[j].start, list[j].duration, 0.6, 0.4);
      };
      const Between at = between_poses(sentence.occurrences, double(i) / 100, hold, near);
      set.data.target.push_back((1 - at.share) * poses[std::size_t(list[at.from].phone)] +
                                at.share * poses[std::size_t(list[at.to].phone)]);
      set.data.use.push_back(1);
    }
    set.data.sentences.push_back(sentence);
  }
  TrainOptions options;
  options.table.pose_prior = 1e-6;
  TrainSummary summary;
  const ProgressFunction progress;
  TrainRun run{summary, progress};
  const Model model = model_of(Method::viseme, VisemeParameters{});
  const auto fitted = kind_of(Method::viseme).fit(set, model, options, run);
  ASSERT_TRUE(fitted);
  const auto& p = std::get<VisemeParameters>(*fitted);
  EXPECT_DOUBLE_EQ(p.place, 0.6);
  EXPECT_DOUBLE_EQ(p.plateau, 0.4);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(p.poses[i], poses[i], 1e-4);
}

TEST(Triphone, ContextsBackOffFromFineToCoarse) {
  TriphoneParameters p;
  p.points = 2;
  const auto curve = [](CurveLevel level, std::int32_t left, std::int32_t right, float value) {
    return ContextCurve{0, level, left, right, 5, {value, value}};
  };
  p.curves = {curve(CurveLevel::phone, kAnyContext, kAnyContext, 1),
              curve(CurveLevel::left_class, 1, kAnyContext, 10),
              curve(CurveLevel::right, kAnyContext, 2, 100),
              curve(CurveLevel::triphone, 1, 2, 1000)};
  const Model model = model_of(Method::triphone, p);
  ASSERT_TRUE(validate(model)) << validate(model).error().describe();
  const auto middle = [&](const char* left, const char* right) {
    return spoken(model, {{"AA", 0, 0.2, left, right}}, 20)[10];
  };
  EXPECT_DOUBLE_EQ(middle("SIL", "SIL"), 1);  // never heard so: the phone alone
  EXPECT_DOUBLE_EQ(middle("P", ""), 11);      // P has the class of B
  EXPECT_DOUBLE_EQ(middle("P", "P"), 111);    // both sides, but not together
  EXPECT_DOUBLE_EQ(middle("B", "P"), 1111);   // exactly this
  EXPECT_DOUBLE_EQ(middle("", "P"), 101);
}

TEST(Triphone, JoinsAreSmoothAndHalfWay) {
  TriphoneParameters p;
  p.points = 2;
  p.curves = {{0, CurveLevel::phone, kAnyContext, kAnyContext, 5, {0, 0}},
              {1, CurveLevel::phone, kAnyContext, kAnyContext, 5, {1, 1}}};
  const Model model = model_of(Method::triphone, p);
  const auto v = spoken(model, {{"AA", 0, 0.2, "", "B"}, {"B", 0.2, 0.2, "AA", ""}}, 40);
  EXPECT_NEAR(v[20], 0.5, 1e-9);
  EXPECT_NEAR(v[5], 0, 0.01);
  EXPECT_NEAR(v[35], 1, 0.01);
  for (std::size_t i = 1; i < v.size(); ++i) {
    EXPECT_GE(v[i], v[i - 1] - 1e-12);
    EXPECT_LT(v[i] - v[i - 1], 0.1);
  }
}

TEST(Triphone, TrainingGivesMeansLessWhatIsKnown) {
  TrainingSet set;
  set.data.controls = 1;
  set.data.rate = 100;
  // AA is 3 after B and 5 after P, six times each.
  for (int s = 0; s < 12; ++s) {
    const std::int32_t left = s % 2 == 0 ? 1 : 2;
    set.data.sentences.push_back({set.data.use.size(), 20, set.data.occurrences.size(), 1});
    set.data.occurrences.push_back({0, 0.2, 0, left, 3, 0});
    set.data.use.insert(set.data.use.end(), 20, 1);
    set.data.target.insert(set.data.target.end(), 20, left == 1 ? 3.0 : 5.0);
  }
  TrainOptions options;
  options.table.trust = 6;
  options.table.minimum = 6;
  TrainSummary summary;
  const ProgressFunction progress;
  TrainRun run{summary, progress};
  Model model = model_of(Method::triphone, TriphoneParameters{});
  const auto fitted = kind_of(Method::triphone).fit(set, model, options, run);
  ASSERT_TRUE(fitted);
  model.parameters = *fitted;
  const auto& curves = std::get<TriphoneParameters>(*fitted).curves;
  ASSERT_GT(curves.size(), 4u);
  EXPECT_NEAR(curves[0].values[0], 4, 1e-6);
  const auto after_b = std::find_if(curves.begin(), curves.end(), [](const ContextCurve& c) {
    return c.level == CurveLevel::left && c.left == 1;
  });
  ASSERT_NE(after_b, curves.end());
  EXPECT_NEAR(after_b->values[0], -0.5, 1e-6);  // half of what is left over: 6 / (6 + trust)
  // left, classes (which see nothing new), triphone: 4 - 1 / 2 - 1 / 4
  EXPECT_NEAR(spoken(model, {{"AA", 0, 0.2, "B", "SIL"}}, 20)[10], 3.25, 1e-6);
  options.table.minimum = 7;
  const auto poor = kind_of(Method::triphone).fit(set, model, options, run);
  ASSERT_TRUE(poor);
  for (const ContextCurve& c : std::get<TriphoneParameters>(*poor).curves) EXPECT_GE(c.count, 7u);
}

}  // namespace table_test
}  // namespace animeme::dam
