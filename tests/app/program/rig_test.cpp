// Characters whose controls are no FAPs: trained, spoken and handed to other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace rig_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// The sample, with its FAPs as two shapes of ARKit and a channel of a rig, from about -1 to 3.
class Rig : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path sample = data_dir() / "grid_s1_sample";
    fs::copy(sample, dir_.path() / "corpus", fs::copy_options::recursive);
    for (const auto& file : fs::directory_iterator(sample / "fap")) {
      const auto faps = dam::read_curves(slurp(file.path().string()));
      ASSERT_TRUE(faps) << faps.error().describe();
      std::string text = "time_s,jawOpen,mouthSmile_L,gloss\n";
      for (std::size_t i = 0; i < faps->frames(); ++i) {
        const double jaw = faps->at(i, 0) / 400;
        const std::string open = std::to_string(std::clamp(jaw, 0.0, 1.0));
        const std::string smile = std::to_string(std::clamp(0.5 - jaw, 0.0, 1.0));
        text += std::to_string(faps->time(i)) + "," + open + "," + smile + "," +
                std::to_string(jaw) + "\n";
      }
      spill(dir_.path() / "corpus" / "fap" / file.path().filename(), text);
    }
  }
  std::string corpus() const { return (dir_.path() / "corpus").string(); }
  void keep_rows(std::size_t rows) const {
    const std::string path = (dir_.path() / "corpus" / "utterances.tsv").string(),
                      all = slurp(path);
    std::size_t end = 0;
    for (std::size_t i = 0; i <= rows; ++i) end = all.find('\n', end) + 1;
    spill(path, all.substr(0, end));
  }
  std::string train(const std::string& name, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "train", corpus(), "-o", dir_ / name, "--max-iterations", "3", "--ridge-factor", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeeds(arguments);
    return dir_ / name;
  }
  dam::Signal curves(const std::string& model, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"speak",   "--text", "Papa was far away. Mama, too.",
                                          "--model", model,    "--style",
                                          "1.5",     "-o",     dir_ / "out.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeeds(arguments);
    const auto signal = dam::read_curves(slurp(dir_ / "out.csv"));
    EXPECT_TRUE(signal) << signal.error().describe();
    return signal ? *signal : dam::Signal{};
  }
  static double least(const dam::Signal& signal, std::size_t channel) {
    double low = 1e9;
    for (std::size_t i = 0; i < signal.frames(); ++i) low = std::min(low, signal.at(i, channel));
    return low;
  }
  static double most(const dam::Signal& signal, std::size_t channel) {
    double high = -1e9;
    for (std::size_t i = 0; i < signal.frames(); ++i) high = std::max(high, signal.at(i, channel));
    return high;
  }

  TempDir dir_;
};

TEST_F(Rig, SpeaksWithinItsLimits) {
  const dam::Signal natural = curves(train("a.dam"));
  for (const std::size_t shape : {0u, 1u}) {
    EXPECT_GE(least(natural, shape), 0);
    EXPECT_LE(most(natural, shape), 1);
  }
  EXPECT_LT(least(natural, 2), 0) << "what is no shape and leaves 0..1 is free";
  // A table in the corpus, and another one by option.
  spill(dir_.path() / "corpus" / "limits.tsv", "control\tlow\thigh\ngloss\t0.1\t0.2\n");
  const dam::Signal table = curves(train("b.dam"));
  EXPECT_DOUBLE_EQ(least(table, 2), 0.1);
  EXPECT_DOUBLE_EQ(most(table, 2), 0.2);
  spill(dir_ / "more.csv", "control,low,high\njawOpen,,0.3\n");
  const dam::Signal option = curves(train("c.dam", {"--limits", dir_ / "more.csv"}));
  EXPECT_DOUBLE_EQ(most(option, 0), 0.3);
  EXPECT_LT(least(option, 2), 0);
  spill(dir_ / "bad.csv", "control,low,high\njawOpen,5,0.3\n");
  const auto bad = animeme({"train", corpus(), "-o", dir_ / "d.dam", "--limits", dir_ / "bad.csv"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("bad.csv:2: the least value of jawOpen"));
  EXPECT_FALSE(fs::exists(dir_ / "d.dam"));
}

TEST_F(Rig, ShapesGoToOtherProgramsAndBecomeAFace) {
  const std::string model = train("a.dam");
  const dam::Signal own = curves(model, {"--idle-motion"});
  const std::vector<std::string> speak = {
      "speak",   "--text",        "Papa was far away. Mama, too.",
      "--model", model,           "--style",
      "1.5",     "--idle-motion", "-o"};
  const auto write = [&](const std::string& name) {
    auto arguments = speak;
    arguments.push_back(dir_ / name);
    succeeds(arguments);
    return dir_ / name;
  };
  const Json json = Json::parse(slurp(write("talk.json")));
  EXPECT_EQ(json["format"], "animeme-arkit");
  ASSERT_EQ(json["frames"].size(), own.frames());
  const std::vector<std::string> names = json["names"];
  const auto jaw = std::size_t(std::find(names.begin(), names.end(), "jawOpen") - names.begin());
  const auto blink =
      std::size_t(std::find(names.begin(), names.end(), "eyeBlinkLeft") - names.begin());
  double closed = 0;
  for (std::size_t i = 0; i < own.frames(); ++i) {
    EXPECT_NEAR(double(json["frames"][i][jaw]), own.at(i, 0), 1e-6);
    closed = std::max(closed, double(json["frames"][i][blink]));
  }
  EXPECT_DOUBLE_EQ(closed, 1) << "--idle-motion closes the eyes";
  EXPECT_EQ(own.names[3], "eyeBlink_L") << "in the spelling of its own";
  const std::string table = slurp(write("talk.livelink.csv"));
  EXPECT_TRUE(table.starts_with("Timecode,BlendShapeCount,EyeBlinkLeft"));
  succeeds({"import", dir_ / "talk.livelink.csv", "-o", dir_ / "back.fap"});
  const auto back = read_clip(dir_ / "back.fap"), face = read_clip(write("talk.fap"));
  ASSERT_EQ(face.frames.size(), own.frames());
  ASSERT_EQ(back.frames.size(), own.frames());
  int moved = 0;
  for (std::size_t i = 0; i < own.frames(); ++i) {
    EXPECT_NEAR(back.frames[i].value[3], face.frames[i].value[3], 1);
    moved = std::max(moved, int(face.frames[i].value[3]));
  }
  EXPECT_GT(moved, 100) << "FAP 3";
  succeeds({"info", write("talk.mp4")});
}

TEST_F(Rig, FapsBecomeShapesWhenWanted) {
  succeeds({"speak", "--text", "Papa", "-o", dir_ / "built_in.json"});
  succeeds({"speak", "--text", "Papa", "-o", dir_ / "built_in.fap"});
  succeeds({"export", dir_ / "built_in.fap", "-o", dir_ / "exported.json"});
  EXPECT_TRUE(slurp(dir_ / "built_in.json") == slurp(dir_ / "exported.json"));
  // Names that tell nothing have curves alone.
  spill(dir_.path() / "corpus" / "limits.tsv", "control\tlow\n");
  const std::string model = train("g.dam", {"--controls", "gloss"});
  const auto none = animeme({"speak", "--text", "Papa", "--model", model, "-o", dir_ / "g.json"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("neither FAPs nor ARKit blend shapes; write them as curves"));
}

TEST_F(Rig, LittleMaterialIsAddedToABase) {
  keep_rows(7);
  const Json rig = json_of({"train", corpus(), "--base", "builtin", "-o", dir_ / "rig.dam"});
  EXPECT_EQ(rig["base"], "builtin");
  EXPECT_EQ(rig["controls"].size(), 3u);
  EXPECT_GT(double(rig["controls"][0]["explained_by_base"]), 0.5) << "jawOpen was made of FAP 3";
  EXPECT_LT(double(rig["held_out"]["adapted"]["nrmse"]), 0.8);
  // Phones that the seven sentences lack are there, and shapes stay within 0..1.
  const dam::Signal spoken = curves(dir_ / "rig.dam");
  EXPECT_GE(least(spoken, 0), 0);
  EXPECT_GT(most(spoken, 0), 0.2);
  const auto text = animeme({"train", corpus(), "--base", dir_ / "rig.dam", "--ridge-factor", "1",
                             "-o", dir_ / "again.dam"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.err, HasSubstr("on held-out sentences, offsets kept"));
  const auto merge =
      animeme({"train", corpus(), "--base", "builtin", "--accumulate", dir_ / "a.sums"});
  EXPECT_EQ(merge.exit_code, 2);
  EXPECT_THAT(merge.err, HasSubstr("--base is for a corpus"));
  const auto none = animeme({"train", corpus(), "--base", dir_ / "none.dam", "-o", dir_ / "b.dam"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("none.dam"));
}

}  // namespace rig_test
}  // namespace animeme::test
