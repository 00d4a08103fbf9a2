// `animeme crossmap`: captured lips to FAPs, ARKit's shapes, tables and heads, as an artist does
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dam/evaluation/evaluate.h"
#include "dam/signal/closure.h"
#include "tests/app/program/commands.h"
#include "tests/support/c3d_writer.h"
#include "tests/support/lip_points.h"
#include "tests/support/program.h"

namespace animeme {
namespace crossmap_test {

using namespace test;
using testing::HasSubstr;

// A folder with six sentences as points.
class CrossmapCommand : public testing::Test {
 protected:
  static constexpr std::size_t kSentences = 6;
  void SetUp() override {
    sentences = lip_sentences();
    ASSERT_GE(sentences.size(), kSentences);
    sentences.resize(kSentences);
    for (const dam::Utterance& sentence : sentences) {
      spill(dir / (sentence.id + ".csv"), lip_table(sentence.signal));
    }
    spill(dir / "neutral.json", lip_neutral());
  }
  std::string take(std::size_t i = 0) const { return dir / (sentences[i].id + ".csv"); }
  std::vector<std::string> command(std::vector<std::string> more, std::size_t takes = 1) const {
    std::vector<std::string> out = {"crossmap"};
    for (std::size_t i = 0; i < takes; ++i) out.push_back(take(i));
    out.insert(out.end(), {"--neutral", dir / "neutral.json"});
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  dam::Signal curves(const std::string& name) const {
    auto read = dam::read_curves(slurp(dir / name));
    EXPECT_TRUE(read) << name << (read ? "" : read.error().describe());
    return read ? *read : dam::Signal{};
  }
  TempDir dir;
  std::vector<dam::Utterance> sentences;
};

TEST_F(CrossmapCommand, SentencesComeBackAsTheFapsTheyWereMadeOf) {
  succeeds(command({"--csv", "-o", dir / "out"}, kSentences));
  std::vector<dam::SentencePair> pairs;
  std::vector<const dam::Utterance*> recorded;
  for (const dam::Utterance& sentence : sentences) {
    pairs.push_back({sentence, curves("out/" + sentence.id + ".csv")});
    recorded.push_back(&sentence);
  }
  dam::ScoreOptions options;
  for (dam::Control& control : dam::recording_scale(recorded)) {
    if (dam::is_scored_lip_fap(control.name)) options.scale.push_back(control);
  }
  const auto score = dam::score(pairs, options);
  ASSERT_TRUE(score) << score.error().describe();
  EXPECT_GT(score->correlation, 0.95);
  ASSERT_GT(score->closure.phones, 3u);
  EXPECT_GE(score->closure.predicted, score->closure.measured);
}

TEST_F(CrossmapCommand, OneRecordingBecomesFapText) {
  succeeds(command({"-o", dir / "take.fap"}));
  const fap::Sequence clip = read_clip(dir / "take.fap");
  EXPECT_EQ(clip.frames.size(), sentences[0].signal.frames());
  EXPECT_EQ(clip.rate, (fap::Rate{25, 1}));
  EXPECT_TRUE(clip.frames[0].mask[5]);
  EXPECT_FALSE(clip.frames[0].mask[16]);  // forward is not seen in a picture
}

TEST_F(CrossmapCommand, ReportsResidualsByFrameAndRegion) {
  const Json report = json_of(command({"--shapes-wanted", "8"}, 2));
  EXPECT_NEAR(double(report["key_shapes"].size()), 8, 1);
  ASSERT_EQ(report["recordings"].size(), 2u);
  const Json& regions = report["recordings"][0]["regions"];
  for (const char* name : {"upper lip", "lower lip", "corners", "jaw"}) {
    ASSERT_TRUE(regions.contains(name)) << name;
    const Json& region = regions[name];
    ASSERT_EQ(region["frames"].size(), sentences[0].signal.frames());
    double sum = 0, worst = 0;
    for (const Json& value : region["frames"]) {
      sum += value.get<double>() * value.get<double>();
      worst = std::max(worst, value.get<double>());
    }
    EXPECT_NEAR(region["rms"].get<double>(), std::sqrt(sum / double(region["frames"].size())),
                1e-3);
    EXPECT_NEAR(region["worst"].get<double>(), worst, 1e-9);
    EXPECT_LT(region["rms"].get<double>(), 1);  // mm
  }
}

// The artist makes a key shape twice as large: the frame that it came from follows.
TEST_F(CrossmapCommand, AdjustedControlsAreWhatTheTargetDoes) {
  succeeds(command(
      {"--csv", "--shapes-wanted", "6", "--write-keys", dir / "keys", "-o", dir / "a.csv"}));
  std::string table = slurp(dir / "keys/controls.csv");
  const auto keys = json_of(command({"--keys", dir / "keys"}))["key_shapes"];
  ASSERT_GE(keys.size(), 5u);
  // The one with the widest mouth, so that its frame is not another key's, too.
  const auto before = curves("a.csv");
  std::string changed = "key,fap3_open_jaw\n";
  for (const Json& key : keys) {
    changed += key["name"].get<std::string>() + "," + (key == keys[2] ? "700" : "0") + "\n";
  }
  spill(dir / "keys/controls.csv", changed);
  succeeds(command({"--csv", "--keys", dir / "keys", "-o", dir / "b.csv"}));
  const auto after = curves("b.csv");
  const auto frame = std::size_t(std::lround(keys[2]["at_s"].get<double>() * 25));
  EXPECT_NEAR(after.at(frame, 0), 700, 35);  // alpha is about 1 there, the ridge shares a little
  EXPECT_THAT(slurp(dir / "keys/sheet.svg"), HasSubstr("<image"));
  ASSERT_EQ(before.frames(), after.frames());
}

TEST_F(CrossmapCommand, ATableOfControlsIsTheSignal) {
  spill(dir / "rig.csv", "key,smile,open\nrest,0,0\nwide,0.2,0.9\n");
  succeeds(command({"--key", "wide=1.0", "--key", "rest=0.6", "--to", dir / "rig.csv", "-o",
                    dir / "rig_out.csv"}));
  const auto made = curves("rig_out.csv");
  EXPECT_THAT(made.names, testing::ElementsAre("smile", "open"));
  EXPECT_NEAR(made.at(25, 1), 0.9, 0.02);
  EXPECT_NEAR(made.at(25, 0), 0.2, 0.01);
  for (std::size_t i = 0; i < made.frames(); ++i) {
    EXPECT_GE(made.at(i, 1), 0);
    EXPECT_LE(made.at(i, 1), 1);
  }
  const auto lacking = animeme(command({"--key", "other=1.0", "--to", dir / "rig.csv", "--json"}));
  EXPECT_EQ(lacking.exit_code, 3);
  EXPECT_THAT(lacking.err, HasSubstr("rig.csv: there is no row for the key shape other"));
}

TEST_F(CrossmapCommand, ArkitShapesStayWithinTheirLimits) {
  succeeds(command({"--to", "arkit", "-o", dir / "arkit.csv"}));
  const auto made = curves("arkit.csv");
  const auto jaw = std::find(made.names.begin(), made.names.end(), "jawOpen");
  ASSERT_NE(jaw, made.names.end());
  EXPECT_EQ(std::find(made.names.begin(), made.names.end(), "cheekSquintLeft"), made.names.end());
  double most = 0;
  for (std::size_t k = 0; k < made.values.size(); ++k) {
    ASSERT_GE(made.values[k], 0);
    ASSERT_LE(made.values[k], 1);
    if (k % made.names.size() == std::size_t(jaw - made.names.begin())) {
      most = std::max(most, made.values[k]);
    }
  }
  EXPECT_GT(most, 0.1);
}

// A mouth of five vertices: the corners, the lips and the chin, that two shapes move.
struct ObjMouth {
  static std::string mesh(double open, double wide, double extra = 0) {
    std::string out = "o mouth\n";
    const double places[][3] = {{25 + 10 * wide, 0, 80},
                                {-25 - 10 * wide, 0, 80},
                                {0, 9, 90},
                                {0, -11 - 20 * open - extra, 88},
                                {0, -42 - 20 * open, 84},
                                {30, 60, 70},
                                {30, 50, 70},
                                {-30, 60, 70},
                                {-30, 50, 70},
                                {0, 24, 100},
                                {0, 0.2, 86},
                                {0, -0.2 - 20 * open, 86}};
    for (const auto& p : places) {
      char line[80];
      std::snprintf(line, sizeof line, "v %g %g %g\n", p[0], p[1], p[2]);
      out += line;
    }
    return out + "f 1 3 2\nf 1 2 4\nf 4 2 5\nf 6 7 8\nf 7 9 8\nf 10 6 8\nf 11 1 2\nf 12 2 1\n";
  }
  static constexpr const char* kPoints =
      "feature_point,vertex\n8.3,0\n8.4,1\n8.1,2\n8.2,3\n2.1,4\n3.1,5\n3.3,6\n3.2,7\n3.4,8\n9.15,"
      "9\n"
      "2.2,10\n2.3,11\n";
};

TEST_F(CrossmapCommand, VerticesOfAnObjHeadAreFittedToItsShapes) {
  spill(dir / "face.obj", ObjMouth::mesh(0, 0));
  spill(dir / "open.obj", ObjMouth::mesh(1, 0));
  spill(dir / "wide.obj", ObjMouth::mesh(0, 1));
  spill(dir / "points.csv", ObjMouth::kPoints);
  const std::vector<std::string> head = {
      "--to",     dir / "face.obj", "--points",      dir / "points.csv",
      "--shapes", dir / "open.obj", dir / "wide.obj"};
  auto first = head;
  first.insert(first.end(), {"--shapes-wanted", "6", "--write-keys", dir / "keys", "-o",
                             dir / "a.csv", "--picture", dir / "sheet.svg"});
  succeeds(command(first));
  const auto guess = curves("a.csv");
  EXPECT_THAT(guess.names, testing::ElementsAre("open", "wide"));
  EXPECT_THAT(slurp(dir / "sheet.svg"), HasSubstr("data:image/png;base64,"));

  // The guess for a key shape is a mesh that the artist can begin with ...
  const auto keys = json_of(command([&] {
    auto more = head;
    more.insert(more.end(), {"--keys", dir / "keys"});
    return more;
  }()))["key_shapes"];
  std::size_t most = 0;
  const auto frame_of = [&](std::size_t k) {
    return std::size_t(std::lround(keys[k]["at_s"].get<double>() * 25));
  };
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (guess.at(frame_of(k), 0) > guess.at(frame_of(most), 0)) most = k;
  }
  const std::string name = keys[most]["name"];
  EXPECT_THAT(slurp(dir / "keys/start/" + name + ".obj"), HasSubstr("f 1 3 2"));
  // ... and saves beside it. Where it was open, this character is half as open and quite wide.
  spill(dir / "keys/" + name + ".obj", ObjMouth::mesh(0.5, 0.8));
  auto second = head;
  second.insert(second.end(), {"--keys", dir / "keys", "-o", dir / "b.csv"});
  const auto result = animeme(command(second));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto made = curves("b.csv");
  EXPECT_NEAR(made.at(frame_of(most), 0), 0.5, 0.02);
  EXPECT_NEAR(made.at(frame_of(most), 1), 0.8, 0.02);

  spill(dir / "keys/" + name + ".obj", "v 0 0 0\n");
  const auto wrong = animeme(command(second));
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("1 vertices, face has 12"));
}

TEST_F(CrossmapCommand, MarkersOfAMotionCaptureInSpace) {
  // The same lips as markers: x back to front, y to the left, z up; one is hidden for a while.
  const dam::Signal& faps = sentences[0].signal;
  C3dFile file;
  file.rate = 25;
  for (const LipPoint& point : kLipPoints) file.labels.push_back("LIP" + std::string(point.id));
  const auto table = dam::read_curves(lip_table(faps));
  ASSERT_TRUE(table);
  for (std::size_t i = 0; i < table->frames(); ++i) {
    std::vector<double>& frame = file.frames.emplace_back();
    for (std::size_t p = 0; p < file.labels.size(); ++p) {
      const bool hidden = p == 2 && i >= 30 && i < 36;
      frame.insert(frame.end(),
                   {5, table->at(i, 2 * p), table->at(i, 2 * p + 1), hidden ? -1.0 : 0});
    }
  }
  const auto bytes = file.bytes();
  spill(dir / "take.c3d", std::string(bytes.begin(), bytes.end()));
  std::string project =
      "inputs = [\"take.c3d\"]\n[capture]\naxes = \"front left up\"\nfapu = {MW = 50, MNS = 24}\n"
      "neutral = \"0-0.2s\"\n[capture.face]\n";
  for (const LipPoint& point : kLipPoints) {
    project += "\"" + std::string(point.id) + "\" = \"LIP" + point.id + "\"\n";
  }
  spill(dir / "project.toml", project + "[target]\nto = \"faps\"\n");
  const auto result = animeme({"crossmap", dir / "project.toml", "--csv", "-o", dir / "c.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("points are missing in 6 frames"));
  const auto made = curves("c.csv");
  const auto lips = dam::inner_lip_channels(made.names),
             known = dam::inner_lip_channels(faps.names);
  ASSERT_TRUE(lips && known);
  double off = 0;
  for (std::size_t i = 0; i < made.frames(); ++i) {
    const double error = (dam::inner_gap(made, i, *lips) - dam::inner_gap(made, 0, *lips)) -
                         (dam::inner_gap(faps, i, *known) - dam::inner_gap(faps, 0, *known));
    off += error * error / double(made.frames());
  }
  EXPECT_LT(std::sqrt(off), 25);  // FAP units
}

TEST_F(CrossmapCommand, SaysWhatIsWrong) {
  const auto says = [&](const std::vector<std::string>& arguments, int code, const char* text) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  says(command({}), 2, "nothing would be written");
  says(command({"-o", dir / "x.fap"}, 2), 3, "written to a folder");
  says(command({"--to", "arkit", "-o", dir / "x.fap"}), 3, "only FAPs");
  says(command({"--use", "8.1,nose", "--json"}), 3, "there is no point 'nose'; there are 2.1");
  says(command({"--key", "M=5.00", "--json"}), 3, "has no frame at 5 s");
  says(command({"--key", "M=soon", "--json"}), 2, "--key");
  says(command({"--fapu", "mouth=3", "--json"}), 3, "'mouth' is no FAP unit");
  says(command({"--to", "rig.glb", "--json"}), 3, "rig.glb");
  says({"crossmap", dir / "none.csv", "--json"}, 3, "none.csv");
  // Points that are on no known place of a face.
  spill(dir / "markers.csv",
        "time_s,A_x,A_y,B_x,B_y\n0,0,0,5,5\n0.04,0,1,5,5\n0.08,0,0,5,6\n"
        "0.12,0,0,5,5\n0.16,0,0,5,5\n0.20,0,0,5,5\n0.24,0,0,5,5\n0.28,0,0,5,5\n");
  says({"crossmap", dir / "markers.csv", "--json"}, 3, "the captured points are not assigned");
  succeeds({"crossmap", dir / "markers.csv", "--to", "keys", "-o", dir / "keys.csv"});
}

TEST_F(CrossmapCommand, ProjectsSayWhereTheyAreWrong) {
  const auto says = [&](const std::string& toml, const char* text) {
    spill(dir / "p.toml", toml);
    const auto result = animeme({"crossmap", dir / "p.toml", "--json"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  says("inputs = [\n", "p.toml:");
  says("inputs = [\"a.csv\"]\n[capture]\nrates = 25\n", "p.toml:3:9: [capture] rates is not a key");
  says("inputs = [\"a.csv\", 3]\n", "p.toml:1:20: inputs is a list of texts");
  says("[fit]\nconvex = 1\n", "p.toml:2:10: [fit] convex is true or false");
  says("[keys]\ncount = 2000\n", "p.toml:2:9: [keys] count is a number from 0 to 200");
  says("[keys]\nnamed = [{name = \"M\", at = 3}]\n", "[keys.named] at is not a key");
  says("[capture.regions]\nlips = {points = [\"a\"], weight = -1}\n", "weight is a number");
  says("", "no recording");
}

TEST_F(CrossmapCommand, RegionsAndWeightsOfAProject) {
  spill(dir / "p.toml",
        "inputs = [\"" + sentences[0].id +
            ".csv\"]\n[capture]\nneutral = \"neutral.json\"\n"
            "points = [\"8.1\", \"8.2\", \"8.3\", \"8.4\", \"2.2\", \"2.3\"]\n"
            "contacts = [[\"2.2\", \"2.3\"]]\n[capture.regions]\nedge = [\"8.3\", \"8.4\"]\n"
            "inner = {points = [\"2.2\", \"2.3\"], weight = 4}\n"
            "[keys]\nnamed = [{name = \"A\", time = 0.8}, {name = \"B\", time = 1.2}]\n"
            "[fit]\nsmooth = 0\nconvex = true\n[target]\nto = \"keys\"\n");
  const Json report = json_of({"crossmap", dir / "p.toml"});
  EXPECT_EQ(report["controls"], Json({"A", "B"}));
  EXPECT_EQ(report["points"].size(), 6u);
  EXPECT_EQ(report["recordings"][0]["regions"].size(), 2u);
  EXPECT_TRUE(report["recordings"][0]["regions"].contains("edge"));
}

TEST_F(CrossmapCommand, TheSameInputGivesTheSameBytes) {
  for (const char* name : {"one", "two"}) {
    succeeds(command({"--to", "arkit", "-o", dir / (std::string(name) + ".csv")}));
    succeeds(command({"--to", "keys", "--picture", dir / (std::string(name) + ".svg")}));
  }
  EXPECT_EQ(slurp(dir / "one.csv"), slurp(dir / "two.csv"));
  EXPECT_EQ(slurp(dir / "one.svg"), slurp(dir / "two.svg"));
  EXPECT_THAT(slurp(dir / "one.svg"), HasSubstr("Key shapes"));
}

}  // namespace crossmap_test
}  // namespace animeme
