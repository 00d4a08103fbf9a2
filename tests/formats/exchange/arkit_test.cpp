// ARKit's curves as a library: read, fitted, written.
#include "tools/formats/exchange/arkit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "tests/support/shared.h"

namespace animeme::exchange {
namespace arkit_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::int64_t> numbers(const fap::Sequence& clip) {
  std::vector<std::int64_t> out;
  for (const fap::Frame& frame : clip.frames) out.push_back(frame.number);
  return out;
}

constexpr const char* kTake =
    "Timecode,BlendShapeCount,JawOpen,EyeBlinkLeft,Weather\n"
    "10:00:00:57.000,61,0,0.5,1\n"
    "10:00:00:58.000,61,0.1,0.5,1\n"
    "10:00:00:59.000,61,0.2,0.5,1\n"
    "10:00:01:00.000,0\n"
    "10:00:01:01.000,61,0.3,0.5,1\n";

TEST(ExchangeArkit, ATakeOfLiveLinkFace) {
  EXPECT_TRUE(is_arkit_table(kTake));
  const auto take = read_arkit_table(kTake);
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_EQ(take->clip.rate, (fap::Rate{60, 1}));
  EXPECT_THAT(numbers(take->clip), ElementsAre(0, 1, 2, 4));
  EXPECT_EQ(take->clip.frames[3].value[3], 408);
  EXPECT_EQ(take->clip.name, "");
  EXPECT_THAT(take->warnings,
              ElementsAre(HasSubstr("ignored: Weather"), HasSubstr("without a face, skipped: 1")));
}

TEST(ExchangeArkit, TheWeightsOfATakeAreThoseOfItsFaces) {
  const auto weights = read_arkit_weights(kTake);
  ASSERT_TRUE(weights) << weights.error().describe();
  EXPECT_EQ(weights->rate, (fap::Rate{60, 1}));
  const auto jaw = std::size_t(*fap::find_arkit("jawOpen"));
  std::vector<double> jaws;
  for (const fap::ArkitFrame& frame : weights->frames) jaws.push_back(frame[jaw]);
  EXPECT_THAT(jaws, ElementsAre(0, 0.1, 0.2, 0.2, 0.3));  // no face in row 3: held
  EXPECT_EQ(read_arkit_weights("time_s,a\n").error().code,
            read_arkit_table("time_s,a\n").error().code);
}

TEST(ExchangeArkit, OptionsTellRateAndUnits) {
  const std::string table = "time_s;jawOpen;headPitch\n0;0;10\n0.04;0;-10\n0.08;0;10\n";
  const auto take = read_arkit_table(table, {fap::Rate{50, 1}, true});
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_THAT(numbers(take->clip), ElementsAre(0, 2, 4));
  EXPECT_EQ(take->clip.frames[0].value[48], 17453);
  EXPECT_THAT(take->warnings, IsEmpty());
  EXPECT_THAT(read_arkit_table(table)->warnings, ElementsAre(HasSubstr("degrees")));
}

TEST(ExchangeArkit, WhatIsWrittenForLiveLinkFaceIsReadBack) {
  fap::Sequence clip{{30000, 1001}, {}, "talk"};
  for (int i = 0; i < 40; ++i) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit("jawOpen"))] = i / 40.0;
    weights[std::size_t(*fap::find_arkit("headYaw"))] = 0.25;
    clip.frames.push_back(fap::arkit_to_fap(weights, fap::kAllArkit));
    clip.frames.back().number = i;
  }
  std::vector<double> told;
  const ArkitCurves curves = fit_arkit(clip, [&](double done) { told.push_back(done); });
  ASSERT_EQ(curves.frames.size(), 40U);
  EXPECT_EQ(told.size(), 40U);
  EXPECT_EQ(told.back(), 1);
  const std::string text = write_live_link(curves);
  EXPECT_THAT(text, AllOf(HasSubstr("Timecode,BlendShapeCount,EyeBlinkLeft,"),
                          HasSubstr("\n00:00:01:00.000,61,")));
  const auto back = read_arkit_table(text, {clip.rate, false});
  ASSERT_TRUE(back) << back.error().describe();
  ASSERT_EQ(back->clip.frames.size(), 40U);
  EXPECT_EQ(back->clip.rate, clip.rate);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(back->clip.frames[i].number, std::int64_t(i));
    EXPECT_NEAR(back->clip.frames[i].value[3], clip.frames[i].value[3], 2);
    EXPECT_NEAR(back->clip.frames[i].value[49], clip.frames[i].value[49], 2);
  }
}

// Lips that meet in P, B and M still meet in the shapes, also where the jaw is open.
TEST(ExchangeArkit, ClosedLipsStayClosed) {
  std::size_t shut = 0, still = 0;
  for (const char* name : {"bbbf9a", "pbwj4p", "bram3s"}) {
    const auto signal =
        dam::read_curves(test::data_file("grid_s1_sample/fap/" + std::string(name) + ".csv"));
    ASSERT_TRUE(signal) << signal.error().describe();
    const auto clip = dam::to_sequence(*signal);
    ASSERT_TRUE(clip);
    const auto curves = fit_arkit(*clip);
    const auto gap = [](const fap::Frame& frame) { return -(frame.value[4] + frame.value[5]); };
    for (std::size_t i = 0; i < clip->frames.size(); ++i) {
      if (gap(clip->frames[i]) > 20) continue;
      ++shut;
      still += gap(fap::arkit_to_fap(curves.frames[i], fap::kAllArkit)) < 45 ? 1 : 0;
    }
  }
  ASSERT_GT(shut, 60u);
  EXPECT_GE(double(still), 0.95 * double(shut)) << still << " of " << shut;
}

TEST(ExchangeArkit, JsonIsForScripts) {
  ArkitCurves curves{{25, 1}, std::vector<fap::ArkitFrame>(2)};
  curves.frames[1][3] = -0.0;
  curves.frames[1][4] = 0.125;
  const auto json = nlohmann::json::parse(write_arkit_json(curves, "a \"b\"\xFF.wav"));
  EXPECT_EQ(json["format"], "animeme-arkit");
  EXPECT_EQ(json["audio"], "a \"b\"\xEF\xBF\xBD.wav");
  EXPECT_EQ(json["names"].size(), 61U);
  EXPECT_EQ(json["frames"].size(), 2U);
  EXPECT_EQ(json["frames"][1][4], 0.125);
  EXPECT_THAT(write_arkit_json(curves),
              AllOf(HasSubstr("\"audio\": null"), testing::Not(HasSubstr("-0.000000"))));
  EXPECT_EQ(nlohmann::json::parse(write_arkit_json({{25, 1}, {}}))["frames"].size(), 0U);
}

TEST(ExchangeArkit, RatesThatAreNone) {
  EXPECT_EQ(read_arkit_table(kTake, {fap::Rate{0, 0}, false}).error().code, Code::invalid_argument);
  EXPECT_EQ(read_arkit_table(kTake, {fap::Rate{0, 1}, false}).error().code, Code::invalid_argument);
  EXPECT_THAT(write_live_link({{0, 0}, std::vector<fap::ArkitFrame>(1)}),
              HasSubstr("\n00:00:00:00.000,61,"));
}

TEST(ExchangeArkit, HostileTables) {
  const std::string head = "time_s,jawOpen,jawLeft\n";
  const struct {
    std::string text;
    Code code;
    std::int64_t line, column;
  } cases[] = {
      {"", Code::truncated, 0, 0},
      {"\xEF\xBB\xBF\r\n\n", Code::truncated, 0, 0},
      {head, Code::truncated, 0, 0},
      {"a,b\n", Code::not_found, 1, 0},
      {"jawOpen,jawLeft\n0,0\n", Code::not_found, 1, 0},
      {"time_s,jawOpen,jawopen\n", Code::syntax, 1, 16},
      {head + "0,0,0\n\n1e999,0,0\n", Code::syntax, 4, 1},
      {head + "0,0,0\n0.04,0,0\n-1e308,0,0\n", Code::out_of_range, 4, 0},
      {head + "-1e308,0,0\n-9.9e307,0,0\n1e308,0,0\n", Code::invalid_argument, 0, 0},
      {head + "0,0,0\n0.04,0,0\n0.08,0,0\n1e300,0,0\n", Code::out_of_range, 5, 0},
      {head + "0,inf,0\n", Code::syntax, 2, 3},
      {head + "0,0\n", Code::syntax, 2, 0},
      {head + "999:99:99:1000,0,0\n", Code::syntax, 2, 1},
      {head + "0,0,0\n5e-324,0,0\n", Code::invalid_argument, 0, 0},
      {head + "0,0,0\n", Code::invalid_argument, 0, 0},
  };
  for (const auto& one : cases) {
    const auto take = read_arkit_table(one.text);
    ASSERT_FALSE(take) << one.text;
    EXPECT_EQ(take.error().code, one.code) << one.text << take.error().describe();
    EXPECT_EQ(take.error().where.line, one.line) << one.text << take.error().describe();
    EXPECT_EQ(take.error().where.column, one.column) << one.text;
  }
}

}  // namespace arkit_test
}  // namespace animeme::exchange
