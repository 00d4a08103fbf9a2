// `animeme export` of visemes and mouth shapes, from scripts and from faces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fap/tables.h"
#include "fap/text.h"
#include "fap/viseme.h"
#include "tests/support/program.h"

namespace animeme {
namespace viseme_export_test {

using nlohmann::json;
using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kScript =
    "start_s\tend_s\tphone\tword\n"
    "0\t0.2\tSIL\t\n"
    "0.2\t0.32\tM\tmy\n"
    "0.32\t0.56\tAY\tmy\n"
    "0.56\t0.64\tHH\thello\n"
    "0.64\t0.72\tAX\thello\n"
    "0.72\t0.8\tL\thello\n"
    "0.8\t1\tOW\thello\n"
    "1\t1.3\tSIL\t\n";

json read_json(const std::string& path) { return json::parse(slurp(path)); }

std::vector<std::string> visemes_of(const json& track) {
  std::vector<std::string> out;
  for (const json& event : track["events"]) out.push_back(event["viseme"]);
  return out;
}

TEST(ExportVisemes, ScriptsHaveEventsAndFades) {
  const TempDir dir;
  spill(dir / "words.tsv", kScript);
  const auto out = animeme({"export", dir / "words.tsv", "--rate", "50", "--audio", "x/my.wav",
                            "-o", dir / "words.visemes.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("10 events, 65 frames of 15 visemes, 50 frames per second"));
  const json track = read_json(dir / "words.visemes.json");
  EXPECT_EQ(track["format"], "animeme-visemes");
  EXPECT_EQ(track["fps"], 50);
  EXPECT_EQ(track["rate"], json({50, 1}));
  EXPECT_EQ(track["audio"], "my.wav");
  ASSERT_EQ(track["names"].size(), 15U);
  for (std::size_t v = 0; v < 15; ++v) EXPECT_EQ(track["names"][v], fap::kVisemes[v].morph);
  // AY and OW are two each, HH waits with the mouth of the vowel behind it.
  EXPECT_THAT(visemes_of(track),
              ElementsAre("viseme_sil", "viseme_PP", "viseme_aa", "viseme_I", "viseme_E",
                          "viseme_E", "viseme_nn", "viseme_O", "viseme_U", "viseme_sil"));
  EXPECT_EQ(track["events"][2]["phone"], "AY");
  EXPECT_NEAR(track["events"][3]["time"], 0.44, 1e-9);
  EXPECT_NEAR(track["events"][3]["duration"], 0.12, 1e-9);
  ASSERT_EQ(track["frames"].size(), 65U);
  for (const json& frame : track["frames"]) {
    ASSERT_EQ(frame.size(), 15U);
    double sum = 0;
    for (const double weight : frame) sum += weight;
    EXPECT_NEAR(sum, 1, 1e-3);
  }
  // The lips meet in the middle of M, and are half way at its borders.
  EXPECT_EQ(track["frames"][13][1], 1);
  EXPECT_NEAR(track["frames"][10][1], 0.5, 1e-4);
  EXPECT_NEAR(track["frames"][16][1], 0.5, 1e-4);
  EXPECT_NEAR(track["frames"][9][1], 0.5 - 0.5 * std::cos(3.14159265 * 0.25), 1e-4);
  EXPECT_EQ(track["frames"][7][0], 1);
}

TEST(ExportVisemes, WithoutCrossfadeVisemesJump) {
  const TempDir dir;
  spill(dir / "words.tsv", kScript);
  const auto out = animeme({"export", dir / "words.tsv", "--crossfade", "0", "--rate", "50", "-o",
                            dir / "words.visemes.csv"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  std::istringstream lines(slurp(dir / "words.visemes.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "time_s,viseme_sil,viseme_PP,viseme_FF,viseme_TH,viseme_DD,viseme_kk,viseme_CH,"
            "viseme_SS,viseme_nn,viseme_RR,viseme_aa,viseme_E,viseme_I,viseme_O,viseme_U");
  int rows = 0;
  while (std::getline(lines, line)) {
    std::size_t ones = 0;
    for (std::size_t at = 0; (at = line.find(",1.0000", at)) != std::string::npos; ++at) ++ones;
    EXPECT_EQ(ones, 1U) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 65);
}

fap::Sequence face_of(const std::vector<int>& visemes, int frames_each) {
  fap::Sequence clip{{25, 1}, {}, "talk"};
  for (const int viseme : visemes) {
    for (int i = 0; i < frames_each; ++i) {
      clip.frames.push_back(fap::viseme_shape(viseme));
      clip.frames.back().number = std::int64_t(clip.frames.size()) - 1;
    }
  }
  return clip;
}

TEST(ExportVisemes, FacesShowVisemes) {
  const TempDir dir;
  spill(dir / "talk.fap", fap::write_text(face_of({0, 1, 11, 2, 0}, 10)));
  const auto out = animeme({"export", dir / "talk.fap", "-o", dir / "talk.visemes.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json track = read_json(dir / "talk.visemes.json");
  EXPECT_EQ(track["audio"], nullptr);
  EXPECT_THAT(visemes_of(track),
              ElementsAre("viseme_sil", "viseme_PP", "viseme_E", "viseme_FF", "viseme_sil"));
  EXPECT_FALSE(track["events"][0].contains("phone"));
  EXPECT_NEAR(track["events"][2]["time"], 0.8, 1e-9);
  EXPECT_EQ(track["frames"].size(), 50U);
}

TEST(ExportVisemes, EventsOfAFaceMayComeFromAScript) {
  const TempDir dir;
  spill(dir / "talk.fap", fap::write_text(face_of({0, 1, 11, 2, 0}, 10)));
  spill(dir / "words.tsv", kScript);
  const auto out = animeme({"export", dir / "talk.fap", "--what", "visemes", "--script",
                            dir / "words.tsv", "-o", dir / "talk.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json track = read_json(dir / "talk.json");
  EXPECT_EQ(track["events"].size(), 10U);
  EXPECT_EQ(track["events"][1]["phone"], "M");
  EXPECT_EQ(track["frames"].size(), 50U);
  EXPECT_GT(double(track["frames"][15][1]), 0.4);
}

TEST(ExportVisemes, CodedVisemesComeThrough) {
  const TempDir dir;
  fap::Sequence clip = face_of({11}, 20);
  for (fap::Frame& frame : clip.frames) {
    frame.mask.set(1);
    frame.viseme = {14, 0, std::int32_t(frame.number * 3), false};
  }
  spill(dir / "talk.fap", fap::write_text(clip));
  ASSERT_EQ(animeme({"export", dir / "talk.fap", "-o", dir / "a.visemes.json"}).exit_code, 0);
  const json track = read_json(dir / "a.visemes.json");
  EXPECT_NEAR(track["frames"][7][14], 21.0 / 63, 1e-4);
  EXPECT_NEAR(track["frames"][7][0], 42.0 / 63, 1e-4);
  // A FAP 1 that never says anything does not hide the lips.
  for (fap::Frame& frame : clip.frames) frame.viseme = {0, 0, 63, false};
  spill(dir / "talk.fap", fap::write_text(clip));
  ASSERT_EQ(animeme({"export", dir / "talk.fap", "-o", dir / "a.visemes.json"}).exit_code, 0);
  EXPECT_GT(double(read_json(dir / "a.visemes.json")["frames"][7][11]), 0.4);
}

TEST(ExportRhubarb, MouthShapesOfAScript) {
  const TempDir dir;
  spill(dir / "words.tsv", kScript);
  ASSERT_EQ(animeme({"export", dir / "words.tsv", "-o", dir / "words.rhubarb.tsv"}).exit_code, 0);
  EXPECT_EQ(
      slurp(dir / "words.rhubarb.tsv"),
      "0.00\tX\n0.20\tA\n0.32\tD\n0.44\tB\n0.56\tC\n0.72\tH\n0.80\tE\n0.90\tF\n1.00\tX\n1.30\tX\n");
  const auto out =
      animeme({"export", dir / "words.tsv", "--audio", "my.wav", "-o", dir / "words.rhubarb.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json cues = read_json(dir / "words.rhubarb.json");
  EXPECT_EQ(cues["metadata"]["soundFile"], "my.wav");
  EXPECT_NEAR(cues["metadata"]["duration"], 1.3, 1e-9);
  ASSERT_EQ(cues["mouthCues"].size(), 9U);
  EXPECT_EQ(cues["mouthCues"][4], json({{"start", 0.56}, {"end", 0.72}, {"value", "C"}}));
}

TEST(ExportVisemes, WhatCannotBeWrittenIsSaid) {
  const TempDir dir;
  spill(dir / "words.tsv", kScript);
  spill(dir / "talk.fap", fap::write_text(face_of({1}, 3)));
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    const char* what;
  } cases[] = {
      {{dir / "words.tsv", "--what", "arkit", "-o", dir / "a.json"}, 3, "a script has no face"},
      {{dir / "talk.fap", "--rate", "60", "-o", dir / "a.visemes.json"},
       2,
       "--rate is for visemes"},
      {{dir / "words.tsv", "--head", "man", "-o", dir / "a.visemes.json"},
       2,
       "--head is for a head"},
      {{dir / "words.tsv", "-o", dir / "a.fbx"}, 2, ".csv"},
      {{dir / "talk.fap", "--what", "visemes", "-o", dir / "a.tsv"}, 2, ".csv or .json"},
      {{dir / "talk.fap", "--what", "rhubarb", "-o", dir / "a.csv"},
       2,
       ".tsv, .xml, .json or .dat"},
      {{dir / "talk.fap", "--what", "phonemes", "-o", dir / "a.csv"}, 2, "--what"},
      {{dir / "talk.fap", "--script", dir / "words.tsv", "-o", dir / "a.json"},
       2,
       "--what visemes"},
      {{dir / "talk.fap", "--script", dir / "none.tsv", "-o", dir / "a.visemes.json"},
       3,
       "none.tsv"},
      {{dir / "words.tsv", "--rate", "fast", "-o", dir / "a.visemes.json"}, 2, "--rate"},
      {{dir / "words.tsv", "--crossfade", "-1", "-o", dir / "a.visemes.json"}, 2, "--crossfade"},
  };
  for (const auto& one : cases) {
    std::vector<std::string> arguments = {"export"};
    arguments.insert(arguments.end(), one.arguments.begin(), one.arguments.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, one.exit_code) << one.what << result.err;
    EXPECT_THAT(result.err, HasSubstr(one.what));
  }
  EXPECT_EQ(dir.files().size(), 2U);
}

TEST(ExportVisemes, HelpNamesTheAvatars) {
  const auto result = animeme({"export", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("Ready Player Me"), HasSubstr("three.js"),
                                HasSubstr("animeme export words.tsv")));
}

}  // namespace viseme_export_test
}  // namespace animeme
