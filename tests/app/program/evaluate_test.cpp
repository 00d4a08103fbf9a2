// `animeme evaluate`, run as a user does, on the sample corpus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dam/corpus/corpus.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace evaluate_test {

using nlohmann::json;
using test::animeme;
using test::TempDir;
using testing::HasSubstr;

const std::string& corpus() {
  static const std::string path = (test::data_dir() / "grid_s1_sample").string();
  return path;
}

/// Two models that differ, trained once.
class Evaluate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir();
    for (const auto& [name, option] :
         {std::pair{"a.dam", "--single-mode"}, {"b.dam", "--plain-sum"}}) {
      const auto made = animeme({"train", corpus(), "--split", "train", "--method", "dam-paper",
                                 option, "-o", *dir_ / name});
      ASSERT_EQ(made.exit_code, 0) << made.err;
    }
  }
  static void TearDownTestSuite() {
    delete dir_;
    dir_ = nullptr;
  }
  static std::string a() { return *dir_ / "a.dam"; }
  static std::string b() { return *dir_ / "b.dam"; }

  static test::ProgramResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "evaluate");
    return animeme(arguments);
  }
  /// With --json; exit code 0 is asserted.
  static json run_json(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "evaluate");
    return test::json_of(arguments);
  }

  static TempDir* dir_;
};
TempDir* Evaluate::dir_ = nullptr;

TEST_F(Evaluate, ShortTextAndFullTables) {
  const auto brief = run({a(), corpus(), "--split", "test"});
  ASSERT_EQ(brief.exit_code, 0) << brief.err;
  for (const char* word :
       {"mean NRMSE", "inner_gap", "corner_height", "P B M closed", "F V contact", "rounded", "lag",
        "dynamics", "in silence", "closed for", "velocity of     jaw"}) {
    EXPECT_THAT(brief.out, HasSubstr(word));
  }
  EXPECT_LT(std::count(brief.out.begin(), brief.out.end(), '\n'), 35);
  const auto full = run({a(), corpus(), "--split", "test", "--full"});
  EXPECT_TRUE(full.out.starts_with(brief.out));
  for (const char* word : {"fap3_open_jaw", "\nviseme", "\nbilabial", "\nprac8p"}) {
    EXPECT_THAT(full.out, HasSubstr(word));
  }
}

TEST_F(Evaluate, JsonHasEverything) {
  const json all = run_json({a(), corpus(), "--split", "test", "--seen-split", "train"});
  EXPECT_EQ(all["utterances"], 6);
  EXPECT_EQ(all["per_utterance"].size(), 6u);
  EXPECT_EQ(all["controls"].size(), 26u);
  EXPECT_EQ(all["dynamics"]["series"].size(), 30u);
  EXPECT_GT(all["mean_nrmse"].get<double>(), 0.3);
  EXPECT_LT(all["mean_nrmse"].get<double>(), all["still_face_nrmse"].get<double>());
  EXPECT_GT(all["silence"]["frames"].get<int>(), 50);
  EXPECT_EQ(all["timing"]["sync"], "in sync");
  EXPECT_LT(std::abs(all["timing"]["lag_ms"].get<double>()), 45);
  EXPECT_LT(all["dynamics"]["velocity"].get<double>(), 1);  // smoother than the recording
  EXPECT_GT(all["dynamics"]["velocity"].get<double>(), 0.2);
  EXPECT_GE(all["measures"]["inner_gap"]["nrmse"].get<double>(), 0.1);
  ASSERT_EQ(all["closure"]["durations"].size(), 3u);
  EXPECT_TRUE(all["closure"]["durations"][2]["to_ms"].is_null());
  EXPECT_GT(all["closure"]["durations"][1]["measured_ms"].get<double>(), 20);
  ASSERT_EQ(all["dynamics"]["groups"].size(), 4u);
  EXPECT_EQ(all["dynamics"]["groups"][3]["name"], "corners");
  ASSERT_EQ(all["by_triphone"].size(), 2u);
  EXPECT_GT(all["by_triphone"][1]["phones"].get<int>(), 0);
  std::size_t frames = 0;
  for (const auto& phone : all["by_phone"]) frames += phone["frames"].get<std::size_t>();
  EXPECT_EQ(frames, all["frames"].get<std::size_t>());
  // Training rows contain all contexts of training rows.
  const json own = run_json({a(), corpus(), "--split", "train", "--seen-split", "train"});
  EXPECT_EQ(own["by_triphone"][1]["phones"], 0);
  EXPECT_EQ(own["by_word"][1]["phones"], 0);
}

TEST_F(Evaluate, FoldsSpeakWhatTheyWereNotTrainedOn) {
  const json all = run_json({"--folds", "4", corpus()});
  EXPECT_EQ(all["utterances"], 24);
  EXPECT_EQ(all["system"], "4 folds of dam");
  EXPECT_GT(all["mean_nrmse"].get<double>(), 0.55);
  EXPECT_LT(all["mean_nrmse"].get<double>(), 0.8);
  const TempDir dir;
  const json few = run_json({"--folds", "2", corpus(), "--split", "test", "--method", "triphone",
                             "--controls", "3-5", "--report", dir / "me.html"});
  EXPECT_EQ(few["utterances"], 6);
  EXPECT_EQ(few["controls"].size(), 3u);
  EXPECT_TRUE(std::filesystem::exists(dir / "me.html"));
  EXPECT_EQ(run({"--folds", "3", a(), corpus()}).exit_code, 2);
  EXPECT_EQ(run({a(), corpus(), "--base", "builtin"}).exit_code, 2);
}

TEST_F(Evaluate, WhatIsLeftWithGainAndOffset) {
  const json all = run_json({a(), corpus(), "--split", "test"});
  const double after = all["mean_nrmse_after_gain_and_offset"];
  EXPECT_LT(after, all["mean_nrmse"].get<double>());
  EXPECT_GT(after, 0.3);
  EXPECT_GT(all["controls"][0]["gain"].get<double>(), 0.5);
  EXPECT_THAT(run({a(), corpus(), "--split", "test"}).out, HasSubstr("gain/offset fit"));
}

TEST_F(Evaluate, TwoModels) {
  const json d = run_json({a(), corpus(), "--split", "test", "--against", b()})["against"];
  EXPECT_EQ(d["sentences"], 6);
  EXPECT_EQ(d["draws"], 1000);
  EXPECT_EQ(d["controls"], 21);
  EXPECT_NEAR(d["nrmse"]["a"].get<double>() - d["nrmse"]["b"].get<double>(),
              d["nrmse"]["difference"].get<double>(), 1e-12);
  EXPECT_LT(d["nrmse"]["low"], d["nrmse"]["high"]);
  EXPECT_NE(d["nrmse"]["difference"], 0);
  const json same = run_json({a(), corpus(), "--split", "test", "--against", a(), "--draws", "50"});
  EXPECT_EQ(same["against"]["nrmse"]["low"], 0);
  EXPECT_EQ(same["against"]["nrmse"]["high"], 0);
  EXPECT_NEAR(same["against"]["nrmse"]["a"].get<double>(), same["mean_nrmse"].get<double>(), 1e-12);
}

TEST_F(Evaluate, TheCodecHasItsOwnError) {
  const json fine = run_json({a(), corpus(), "--split", "test", "--codec"})["codec"];
  const json coarse =
      run_json({a(), corpus(), "--split", "test", "--codec", "--quant", "8"})["codec"];
  EXPECT_GT(fine["error"]["mean_nrmse"].get<double>(), 0);
  EXPECT_LT(fine["error"]["mean_nrmse"].get<double>(), 0.1);
  EXPECT_GT(coarse["error"]["mean_nrmse"], fine["error"]["mean_nrmse"]);
  EXPECT_LT(coarse["kbps"], fine["kbps"]);
  const json exact =
      run_json({a(), corpus(), "--split", "test", "--codec", "--quant", "0"})["codec"];
  // What rounding to whole FAP units leaves.
  EXPECT_LT(exact["error"]["measures"]["jaw"]["max"].get<double>(), 0.5001);
  EXPECT_GT(exact["error"]["measures"]["jaw"]["max"].get<double>(), 0.1);
  EXPECT_NEAR(exact["total"]["mean_nrmse"].get<double>(),
              run_json({a(), corpus(), "--split", "test"})["mean_nrmse"].get<double>(), 0.002);
  const json rated =
      run_json({a(), corpus(), "--split", "test", "--codec", "--kbps", "2"})["codec"];
  EXPECT_LT(rated["kbps"].get<double>(), 2.05);
  EXPECT_EQ(run({a(), corpus(), "--quant", "3"}).exit_code, 2);
}

/// Writes what speak makes for the test rows, at the recordings' length, as .csv.
void write_tracks(const std::string& folder, const std::string& model,
                  const std::string& extension) {
  std::filesystem::create_directory(folder);
  dam::CorpusOptions options;
  options.split_value = "test";
  const auto read = dam::read_corpus(corpus(), options);
  ASSERT_TRUE(read);
  for (const dam::Utterance& u : read->utterances) {
    const auto made =
        animeme({"speak", "--model", model, "--script", corpus() + "/phonemes/" + u.id + ".tsv",
                 "--articulate", "0", "--no-idle-motion", "-o", folder + "/" + u.id + extension});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
}

TEST_F(Evaluate, TracksOfOthersAreScoredAlike) {
  const TempDir dir;
  write_tracks(dir / "csv", a(), ".csv");
  const json model = run_json({a(), corpus(), "--split", "test"});
  const json tracks = run_json({"--tracks", dir / "csv", corpus(), "--split", "test"});
  EXPECT_NEAR(tracks["measures"]["jaw"]["rmse"].get<double>(),
              model["measures"]["jaw"]["rmse"].get<double>(), 0.02);
  EXPECT_EQ(tracks["closure"]["predicted"], model["closure"]["predicted"]);
  EXPECT_NEAR(tracks["dynamics"]["velocity"].get<double>(),
              model["dynamics"]["velocity"].get<double>(), 0.01);
  // FAP text is rounded to whole units.
  write_tracks(dir / "fap", a(), ".fap");
  const json text = run_json({"--tracks", dir / "fap", corpus(), "--split", "test"});
  EXPECT_NEAR(text["measures"]["jaw"]["rmse"].get<double>(),
              model["measures"]["jaw"]["rmse"].get<double>(), 0.5);
  // And against a model.
  const json d = run_json({"--tracks", dir / "csv", corpus(), "--split", "test", "--against", a()});
  EXPECT_NEAR(d["against"]["nrmse"]["difference"].get<double>(), 0, 1e-3);
  // A recording against itself has no error.
  const json own = run_json({"--tracks", corpus() + "/fap", corpus()});
  EXPECT_EQ(own["mean_nrmse"], 0);
  EXPECT_EQ(own["timing"]["misalignment_ms"], 0);
}

TEST_F(Evaluate, TracksThatDoNotFit) {
  const TempDir dir;
  write_tracks(dir / "csv", a(), ".csv");
  std::filesystem::remove(dir / "csv/prac8p.csv");
  const auto missing = run({"--tracks", dir / "csv", corpus(), "--split", "test"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("prac8p"));
  const auto skipped =
      run_json({"--tracks", dir / "csv", corpus(), "--split", "test", "--skip-missing"});
  EXPECT_EQ(skipped["utterances"], 5);
  const auto both = run({a(), corpus(), "--tracks", dir / "csv"});
  EXPECT_EQ(both.exit_code, 2);
  // Another rate.
  const auto made = animeme({"speak", "--model", a(), "--rate", "30", "--script",
                             corpus() + "/phonemes/prac8p.tsv", "-o", dir / "csv/prac8p.csv"});
  ASSERT_EQ(made.exit_code, 0);
  EXPECT_EQ(run({"--tracks", dir / "csv", corpus(), "--split", "test"}).exit_code, 3);
}

TEST_F(Evaluate, ThresholdsForScripts) {
  const std::vector<std::string> base = {a(), corpus(), "--split", "test"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    return run(more);
  };
  EXPECT_EQ(with({"--max-nrmse", "2", "--min-closed", "90"}).exit_code, 0);
  const auto error = with({"--max-nrmse", "0.1"});
  EXPECT_EQ(error.exit_code, 1);
  EXPECT_THAT(error.err, HasSubstr("NRMSE"));
  EXPECT_THAT(error.err, HasSubstr("above 0.1"));
  const auto open = with({"--no-closure", "--min-closed", "100"});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_THAT(open.err, HasSubstr("closed"));
  const auto stray = with({"--closed-gap", "250", "--max-false-per-minute", "0"});
  EXPECT_EQ(stray.exit_code, 1);
  EXPECT_THAT(stray.err, HasSubstr("false closures"));
}

TEST_F(Evaluate, Pictures) {
  const TempDir dir;
  const auto svg = run({a(), corpus(), "--split", "test", "--picture", dir / "p.svg"});
  ASSERT_EQ(svg.exit_code, 0) << svg.err;
  const std::string drawn = test::slurp(dir / "p.svg");
  for (const char* word : {">best: ", ">median: ", ">worst: ", ">jaw<", ">inner gap<", ">width<",
                           ">recorded<", ">made<", "#ffd9b3"}) {
    EXPECT_THAT(drawn, HasSubstr(word));
  }
  EXPECT_EQ(run({a(), corpus(), "--picture", dir / "p.gif"}).exit_code, 2);
  const auto png = run({a(), corpus(), "--split", "test", "--picture", dir / "p.png"});
  if (png.exit_code == 3 && png.err.find("cannot draw SVG") != std::string::npos) {
    GTEST_SKIP() << "this FFmpeg has no librsvg";
  }
  ASSERT_EQ(png.exit_code, 0) << png.err;
  EXPECT_TRUE(test::slurp(dir / "p.png").starts_with("\x89PNG\r\n"));
}

TEST_F(Evaluate, AnyRig) {
  // The sample's curves under names that are no FAPs: no measures, but errors and timing.
  const TempDir dir;
  std::filesystem::copy(corpus(), dir / "rig", std::filesystem::copy_options::recursive);
  for (const auto& entry : std::filesystem::directory_iterator(dir / "rig/fap")) {
    std::string text = test::slurp(entry.path());
    for (std::size_t at = 0; (at = text.find(",fap", at)) != std::string::npos;) {
      text.replace(at, 4, ",rig");
    }
    test::spill(entry.path(), text);
  }
  ASSERT_EQ(animeme({"train", dir / "rig", "-o", dir / "rig.dam", "--ridge-factor", "1"}).exit_code,
            0);
  const json all = run_json({dir / "rig.dam", dir / "rig", "--picture", dir / "p.svg"});
  EXPECT_TRUE(all["measures"].empty());
  EXPECT_EQ(all["closure"]["phones"], 0);
  EXPECT_EQ(all["controls"][0]["scored"], true);
  EXPECT_TRUE(all["timing"]["lag_ms"].is_number());
  EXPECT_THAT(test::slurp(dir / "p.svg"), HasSubstr(">rig3_open_jaw<"));
  EXPECT_EQ(run({dir / "rig.dam", dir / "rig", "--min-closed", "50"}).exit_code, 1);
  EXPECT_EQ(run({dir / "rig.dam", dir / "rig", "--max-false-per-minute", "9"}).exit_code, 1);
  EXPECT_EQ(run({dir / "rig.dam", dir / "rig", "--codec"}).exit_code, 3);
}

}  // namespace evaluate_test
}  // namespace animeme
