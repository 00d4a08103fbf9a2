// The mean motion of what may have been said.
#include "dam/speaking/readings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dam/model/builtin.h"
#include "dam/signal/closure.h"

namespace animeme::dam {
namespace readings_test {

Script script_of(std::initializer_list<const char*> labels) {
  Script script;
  for (const char* label : labels) {
    const double start = script.duration();
    script.phones.push_back({start, start + 0.1, label, {}});
  }
  return script;
}

Model model() {
  auto one = builtin_model();
  EXPECT_TRUE(one);
  return std::move(*one);
}

TEST(Readings, OneThatAllAgreeOnIsThatOne) {
  const Model face = model();
  const Script script = script_of({"SIL", "AA", "D", "IY", "SIL"});
  const std::vector<Script> readings(5, script);
  const auto mean = synthesise_readings(face, readings, script);
  const auto one = synthesise(face, script);
  ASSERT_TRUE(mean && one);
  ASSERT_EQ(mean->values.size(), one->values.size());
  for (std::size_t i = 0; i < one->values.size(); ++i)
    EXPECT_NEAR(mean->values[i], one->values[i], 1e-6);
}

TEST(Readings, DoubtLiesBetween) {
  const Model face = model();
  const Script open = script_of({"SIL", "AA", "AA", "AA", "SIL"}),
               narrow = script_of({"SIL", "IY", "IY", "IY", "SIL"});
  const std::vector<Script> readings{open, narrow};
  const auto mean = synthesise_readings(face, readings, open);
  const auto a = synthesise(face, open), b = synthesise(face, narrow);
  ASSERT_TRUE(mean && a && b);
  const auto jaw = std::size_t(face.find_control("fap3_open_jaw"));
  const std::size_t middle = 6;
  EXPECT_NEAR(mean->at(middle, jaw), 0.5 * (a->at(middle, jaw) + b->at(middle, jaw)), 1e-6);
}

TEST(Readings, LipsCloseWhereMostAgree) {
  const Model face = model();
  const Script agreed = script_of({"SIL", "AA", "B", "AA", "SIL"}),
               other = script_of({"SIL", "AA", "D", "AA", "SIL"});
  const std::vector<Script> readings{agreed, other, agreed};
  SynthesisOptions loose;
  loose.closure = false;
  SynthesisReport report;
  const auto closed = synthesise_readings(face, readings, agreed, {}, &report);
  const auto ajar = synthesise_readings(face, readings, agreed, loose);
  ASSERT_TRUE(closed && ajar);
  const auto lips = inner_lip_channels(closed->names);
  ASSERT_TRUE(lips);
  const auto least = [&](const Signal& signal) {
    double gap = 1e9;
    for (std::size_t i = 4; i <= 8; ++i) gap = std::min(gap, inner_gap(signal, i, *lips));
    return gap;
  };
  EXPECT_LT(least(*closed), kClosedGap);
  EXPECT_GT(least(*ajar), least(*closed));
  EXPECT_EQ(report.phones, 5u);
}

TEST(Readings, SomeFramesAreThoseOfAll) {
  const Model face = model();
  const Script script = script_of({"SIL", "AA", "D", "IY", "UW", "SIL"});
  SynthesisOptions options;
  options.rest_at_ends = false;
  options.closure = false;
  const std::vector<Script> readings(2, script);
  const auto all = synthesise_readings(face, readings, script, options);
  const auto some = synthesise_readings(face, readings, script, options, {5, 4});
  ASSERT_TRUE(all && some);
  EXPECT_EQ(some->first_frame, 5u);
  ASSERT_EQ(some->frames(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(some->at(i, 0), all->at(5 + i, 0), 1e-6);
}

TEST(Readings, SayWhatIsWrong) {
  const Model face = model();
  const Script script = script_of({"SIL", "AA"});
  EXPECT_EQ(synthesise_readings(face, {}, script).error().code, Code::invalid_argument);
  const std::vector<Script> uneven{script, script_of({"SIL", "AA", "SIL"})};
  EXPECT_EQ(synthesise_readings(face, uneven, script).error().code, Code::invalid_argument);
  const std::vector<Script> wrong{script_of({"QQQ"})};
  EXPECT_FALSE(synthesise_readings(face, wrong, script));
  EXPECT_FALSE(synthesise_readings(face, wrong, script, {}, ReadingFrames{0, 2}));
}

}  // namespace readings_test
}  // namespace animeme::dam
