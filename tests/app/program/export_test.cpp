// `animeme export`: curves for programs that know ARKit's shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fap/arkit.h"
#include "fap/text.h"
#include "tests/support/program.h"

namespace animeme {
namespace export_test {

using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::HasSubstr;

fap::ArkitFrame smile(double jaw) {
  fap::ArkitFrame weights{};
  weights[std::size_t(*fap::find_arkit("jawOpen"))] = jaw;
  weights[std::size_t(*fap::find_arkit("mouthSmileLeft"))] = 0.4;
  weights[std::size_t(*fap::find_arkit("mouthSmileRight"))] = 0.4;
  weights[std::size_t(*fap::find_arkit("eyeBlinkRight"))] = jaw;
  weights[std::size_t(*fap::find_arkit("headYaw"))] = 0.1;
  return weights;
}

// Half a minute and a bit at `rate`; the jaw opens and closes once a second.
fap::Sequence talk(fap::Rate rate) {
  fap::Sequence clip{rate, {}, "talk"};
  const int frames = int(rate.frames_per_second() * 31);
  for (int i = 0; i < frames; ++i) {
    const double jaw = 0.3 - 0.3 * std::cos(6.2831853 * rate.seconds(i));
    clip.frames.push_back(fap::arkit_to_fap(smile(jaw), fap::kAllArkit));
    clip.frames.back().number = i;
  }
  return clip;
}

TEST(Export, LiveLinkFaceComesBackAsTheSameFace) {
  for (const fap::Rate rate : {fap::Rate{10, 1}, fap::Rate{25, 1}, fap::Rate{60, 1}}) {
    const TempDir dir;
    const fap::Sequence clip = talk(rate);
    spill(dir / "talk.fap", fap::write_text(clip));
    const auto out = animeme({"export", dir / "talk.fap", "-o", dir / "talk.csv"});
    ASSERT_EQ(out.exit_code, 0) << out.err;
    EXPECT_THAT(slurp(dir / "talk.csv"),
                testing::StartsWith("Timecode,BlendShapeCount,EyeBlinkLeft,EyeLookDownLeft,"));
    const auto back = animeme({"import", dir / "talk.csv", "-o", dir / "back.fap"});
    ASSERT_EQ(back.exit_code, 0) << back.err;
    const auto again = fap::read_text(slurp(dir / "back.fap"));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->rate, rate);
    ASSERT_EQ(again->frames.size(), clip.frames.size());
    double error = 0;
    double power = 0;
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      EXPECT_EQ(again->frames[i].number, std::int64_t(i));
      for (std::size_t fap = 3; fap <= 22; ++fap) {
        error += std::pow(clip.frames[i].value[fap] - again->frames[i].value[fap], 2);
        power += std::pow(clip.frames[i].value[fap], 2);
      }
      EXPECT_NEAR(again->frames[i].value[49], clip.frames[i].value[49], 1);  // the head, exactly
    }
    EXPECT_LT(std::sqrt(error / power), 0.06);
  }
}

TEST(Export, JsonHasNamesFramesAndTheSound) {
  const TempDir dir;
  fap::Sequence clip = talk({30000, 1001});
  clip.frames.resize(3);
  spill(dir / "talk.fap", fap::write_text(clip));
  const auto out = animeme(
      {"export", dir / "talk.fap", "--audio", "some/voice \"1\".wav", "-o", dir / "talk.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const auto json = nlohmann::json::parse(slurp(dir / "talk.json"));
  EXPECT_EQ(json["format"], "animeme-arkit");
  EXPECT_EQ(json["rate"], nlohmann::json({30000, 1001}));
  EXPECT_NEAR(json["fps"], 29.97002997, 1e-8);
  EXPECT_EQ(json["audio"], "voice \"1\".wav");
  ASSERT_EQ(json["names"].size(), 61u);
  EXPECT_EQ(json["names"][17], "jawOpen");
  ASSERT_EQ(json["frames"].size(), 3u);
  EXPECT_EQ(json["frames"][0].size(), 61u);
  EXPECT_NEAR(json["frames"][0][23], 0.4, 0.05);
}

TEST(Export, WhatCannotBeWrittenIsSaid) {
  const TempDir dir;
  spill(dir / "talk.fap", fap::write_text(talk({25, 1})));
  const auto wrong = animeme({"export", dir / "talk.fap", "-o", dir / "talk.fbx"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr(".csv"));
  const auto missing = animeme({"export", dir / "none.fap", "-o", dir / "talk.csv"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.fap"));
}

}  // namespace export_test
}  // namespace animeme
