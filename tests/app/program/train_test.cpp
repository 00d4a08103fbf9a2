// `animeme train`, run as a user does: in one go and in parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dam/model/model.h"
#include "dam/script/script.h"
#include "dam/training/alignment.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace train_test {

using nlohmann::json;
using test::animeme;
using test::TempDir;
using testing::AllOf;
using testing::HasSubstr;

const std::string& corpus() {
  static const std::string path = (test::data_dir() / "grid_s1_sample").string();
  return path;
}

test::ProgramResult train(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "train");
  return animeme(arguments);
}

/// With --json; exit code 0 is asserted.
json train_json(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const auto result = train(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

/// For tests that ask little of the model: one step, no search for the ridges, which is half of the
/// time.
const std::vector<std::string> kBriefly = {"--ridge-factor", "1", "--max-iterations", "1"};

std::vector<std::string> briefly(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kBriefly.begin(), kBriefly.end());
  return arguments;
}

TEST(Train, ReportsStepsAndWhatItFound) {
  const TempDir dir;
  const json all = train_json({corpus(), "-o", dir / "m.dam"});
  EXPECT_EQ(all["utterances"], 24);
  EXPECT_EQ(all["converged"], true);
  ASSERT_EQ(all["steps"].size(), all["iterations"].get<std::size_t>());
  for (std::size_t i = 0; i < all["steps"].size(); ++i) {
    const double before = all["objective"][i], after = all["objective"][i + 1];
    EXPECT_DOUBLE_EQ(all["steps"][i]["objective"].get<double>(), after);
    EXPECT_NEAR(all["steps"][i]["relative_fall"].get<double>(), (before - after) / before, 1e-12);
  }
  EXPECT_GT(all["ridge_factor"], 0);
  EXPECT_EQ(all["explained"].size(), 26u);
  EXPECT_EQ(all["explained_on"], "held_out");
  EXPECT_EQ(all["unknown_phones"][0]["spoken_as"], "AH");
  EXPECT_FALSE(all["rare_phones"].empty());
  const auto text =
      train({corpus(), "--split", "test", "-o", dir / "m.dam", "--max-iterations", "1", "-v"});
  EXPECT_THAT(text.err, AllOf(HasSubstr("step 1: objective"), HasSubstr("% less"),
                              HasSubstr("stopped after 1 steps"), HasSubstr("ridge factor"),
                              HasSubstr("leans on"), HasSubstr("replaced by similar phones")));
}

/// The sample with changes.
class TrainOdd : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy(corpus(), folder(), std::filesystem::copy_options::recursive);
  }
  std::string folder() const { return dir_ / "corpus"; }
  std::filesystem::path curves(const std::string& id) const {
    return std::filesystem::path(folder()) / "fap" / (id + ".csv");
  }
  /// One cell of a sentence's table, or a whole column; row 0 is the header.
  void blank(const std::string& id, std::size_t column, std::size_t from, std::size_t to,
             const std::string& with) const {
    std::istringstream in(test::slurp(curves(id)));
    std::string out, line;
    for (std::size_t row = 0; std::getline(in, line); ++row) {
      std::size_t begin = 0;
      for (std::size_t c = 0; c < column; ++c) begin = line.find(',', begin) + 1;
      if (row >= from && row < to) line.replace(begin, line.find(',', begin) - begin, with);
      out += line + "\n";
    }
    test::spill(curves(id), out);
  }
  TempDir dir_;
};

TEST_F(TrainOdd, BlanksAreLeftOutAndNamed) {
  blank("bgahzn", 1, 20, 23, "#N/A");
  blank("bram3s", 3, 1, 1000, "");
  const auto text = train(briefly({folder(), "-o", dir_ / "m.dam"}));
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.err, AllOf(HasSubstr("sentence 'bgahzn': fap3_open_jaw blank in 3 of 75 rows, "
                                        "first in line 21; skipped"),
                              HasSubstr("sentence 'bram3s' is skipped: fap5_raise_b_midlip is "
                                        "blank throughout")));
  const json all = train_json(briefly({folder(), "-o", dir_ / "m.dam"}));
  EXPECT_EQ(all["utterances"], 23);
  ASSERT_EQ(all["blanks"].size(), 2u);
  EXPECT_EQ(all["blanks"][0]["id"], "bgahzn");
  EXPECT_EQ(all["blanks"][0]["first_line"], 21);
  const json parts = train_json({folder(), "--accumulate", dir_ / "s.stats"});
  EXPECT_EQ(parts["utterances"], 23);
  EXPECT_EQ(parts["blanks"].size(), 2u);
  const auto scored = animeme({"evaluate", "builtin", folder(), "--json"});
  EXPECT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_EQ(json::parse(scored.out)["blanks"].size(), 2u);
  EXPECT_EQ(json::parse(scored.out)["utterances"], 23);
  // Bending tries each sentence without the others: of six, to be short.
  std::istringstream rows(test::slurp(folder() + "/utterances.tsv"));
  std::string few, row;
  for (int others = 0; std::getline(rows, row);) {
    const bool blanked = row.starts_with("bgahzn") || row.starts_with("bram3s");
    if (blanked || others++ < 5) few += row + "\n";
  }
  test::spill(folder() + "/utterances.tsv", few);
  const json bent = train_json({folder(), "-o", dir_ / "b.dam", "--base", dir_ / "m.dam",
                                "--controls", "3-5", "--ridge-factor", "1"});
  EXPECT_EQ(bent["blanks"].size(), 2u);
}

TEST_F(TrainOdd, AControlThatIsBlankEverywhereIsAnError) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(folder()) / "fap"))
    blank(entry.path().stem().string(), 2, 1, 1000, "NaN");
  const auto refused = train({folder(), "-o", dir_ / "m.dam"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("'fap4_lower_t_midlip'"), HasSubstr("every sentence")));
  EXPECT_EQ(train(briefly({folder(), "-o", dir_ / "m.dam", "--controls", "3,5"})).exit_code, 0);
}

TEST_F(TrainOdd, LagsAreFoundAndTakenOff) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(folder()) / "phonemes")) {
    auto script = dam::read_script(test::slurp(entry.path()));
    ASSERT_TRUE(script);
    test::spill(entry.path(), dam::write_script_tsv(dam::shifted_script(*script, -0.16)));
  }
  const auto late = train(briefly({folder(), "-o", dir_ / "m.dam"}));
  EXPECT_THAT(late.err, HasSubstr(" ms after the sound"));
  const auto text = train(briefly({folder(), "-o", dir_ / "m.dam", "--lag", "auto"}));
  EXPECT_THAT(text.err, AllOf(HasSubstr("scripts were shifted by +1"),
                              HasSubstr("sound and motion are synchronous")));
  const json given = train_json(briefly({folder(), "-o", dir_ / "m.dam", "--lag", "160"}));
  EXPECT_NEAR(given["alignment"]["lag_ms"].get<double>(), 0, 15);
  const auto score = [&](const std::string& lag) {
    const auto result = animeme({"evaluate", dir_ / "m.dam", folder(), "--json", "--lag", lag});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["mean_nrmse"].get<double>();
  };
  EXPECT_LT(score("auto"), 0.8 * score("0"));
  EXPECT_NEAR(score("auto"), score("160"), 0.02);
  EXPECT_EQ(train({folder(), "-o", dir_ / "m.dam", "--lag", "much"}).exit_code, 2);
  EXPECT_EQ(train({folder(), "--accumulate", dir_ / "s", "--lag", "auto"}).exit_code, 2);
  EXPECT_EQ(train({folder(), "--accumulate", dir_ / "s", "--lag", "160"}).exit_code, 0);
}

/// A base, and parts for two halves of the sample: made once, as CTest runs these tests together,
/// and changed by none.
class TrainParts : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new TempDir();
    ASSERT_EQ(train({corpus(), "-o", base(), "--ridge-factor", "1"}).exit_code, 0);
    ASSERT_EQ(part("train", a()).exit_code, 0);
    ASSERT_EQ(part("test", b()).exit_code, 0);
  }
  static void TearDownTestSuite() {
    delete made_;
    made_ = nullptr;
  }
  static std::string base() { return *made_ / "base.dam"; }
  static std::string a() { return *made_ / "a.stats"; }
  static std::string b() { return *made_ / "b.stats"; }
  static test::ProgramResult part(const std::string& split, const std::string& file) {
    return train({corpus(), "--split", split, "--accumulate", file, "--dominance", base()});
  }
  static TempDir* made_;
  TempDir dir_;
};
TempDir* TrainParts::made_ = nullptr;

TEST_F(TrainParts, MergedTheyAreTheModelOfTheWholeInAnyOrder) {
  const json ab = train_json({"--merge", a(), b(), "-o", dir_ / "ab.dam"});
  const json ba = train_json({"--merge", b(), a(), "-o", dir_ / "ba.dam"});
  EXPECT_EQ(test::slurp(dir_ / "ab.dam"), test::slurp(dir_ / "ba.dam"));
  EXPECT_EQ(ab["utterances"], 24);
  EXPECT_EQ(ab["explained"], ba["explained"]);
  const auto model = dam::load_model(dir_ / "ab.dam"), whole = dam::load_model(base());
  ASSERT_TRUE(model && whole);
  EXPECT_EQ(model->phones, whole->phones);
  EXPECT_THAT(model->provenance, HasSubstr("24 utterances, from sums"));
  EXPECT_EQ(animeme({"evaluate", dir_ / "ab.dam", corpus(), "--max-nrmse", "0.56"}).exit_code, 0);
}

TEST_F(TrainParts, TheSameCommandAgainAddsNothing) {
  const std::string before = test::slurp(a());
  const json again =
      train_json({corpus(), "--split", "train", "--accumulate", a(), "--dominance", base()});
  EXPECT_EQ(again["added"], 0);
  EXPECT_EQ(again["already_there"], again["utterances"]);
  EXPECT_EQ(test::slurp(a()), before);
}

TEST(TrainAlone, OneProgramAtATimeAddsToAFile) {
  const test::TempDir dir;
  const std::string sums = dir / "a.stats";
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  // Somebody is at it.
  const auto second = test::run_command(
      {"sh", "-c",
       "exec 9>" + test::quoted(dir / ".a.stats.lock") + "; flock 9; " + program + " train " +
           test::quoted(dir.path().string()) + " --accumulate " + test::quoted(sums)});
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_THAT(second.err, ::testing::HasSubstr("another program is writing to this file"));
  EXPECT_FALSE(std::filesystem::exists(sums));
}

TEST_F(TrainParts, AnInterruptedRunGoesOn) {
  // A corpus whose last sentence cannot be read: what came before is kept.
  const auto copy = dir_.path() / "corpus";
  std::filesystem::copy(corpus(), copy, std::filesystem::copy_options::recursive);
  std::string last;
  for (const auto& entry : std::filesystem::directory_iterator(copy / "phonemes"))
    last = std::max(last, entry.path().filename().string());
  const std::string good = test::slurp(copy / "phonemes" / last);
  test::spill(copy / "phonemes" / last, "start_s\tend_s\tphone\n0\t1\tQQ\n");
  const std::vector<std::string> command = {
      copy.string(), "--accumulate", dir_ / "c.stats", "--dominance", base(), "--save-every", "5"};
  const auto stopped = train(command);
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr(last), HasSubstr("QQ")));
  test::spill(copy / "phonemes" / last, good);
  const json resumed = train_json(command);
  EXPECT_EQ(resumed["utterances"], 24);
  EXPECT_GT(resumed["already_there"], 0);
  EXPECT_EQ(resumed["added"].get<int>() + resumed["already_there"].get<int>(), 24);
  ASSERT_EQ(train({corpus(), "--accumulate", dir_ / "d.stats", "--dominance", base()}).exit_code,
            0);
  EXPECT_EQ(test::slurp(dir_ / "c.stats"), test::slurp(dir_ / "d.stats"));
  // A sentence that changed is refused by name.
  test::spill(copy / "phonemes" / last, "start_s\tend_s\tphone\n0\t1\tSIL\n1\t2\tAA\n2\t3\tSIL\n");
  const auto changed = train(command);
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_THAT(changed.err, AllOf(HasSubstr(last.substr(0, last.find('.'))), HasSubstr("changed")));
}

TEST_F(TrainParts, WhatDoesNotBelongTogetherIsRefusedWithTheFile) {
  const auto fails = [&](std::vector<std::string> arguments, const std::string& file,
                         const std::string& why) {
    const auto result = train(std::move(arguments));
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr(file), HasSubstr(why)));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "no.dam"));
  };
  ASSERT_EQ(train({corpus(), "--split", "test", "--accumulate", dir_ / "plain.stats"}).exit_code,
            0);
  fails({"--merge", a(), dir_ / "plain.stats", "-o", dir_ / "no.dam"}, ".stats", "dominance");
  fails({corpus(), "--accumulate", dir_ / "plain.stats", "--dominance", base()}, "plain.stats",
        "dominance");
  fails({corpus(), "--accumulate", a(), "--controls", "3-5"}, corpus(), "controls");
  fails({"--merge", a(), a(), "-o", dir_ / "no.dam"}, "a.stats", "twice");
  test::spill(dir_ / "cut.stats", test::slurp(a()).substr(0, 5000));
  fails({"--merge", dir_ / "cut.stats", "-o", dir_ / "no.dam"}, "cut.stats", "cut off");
  fails({corpus(), "--accumulate", dir_ / "cut.stats"}, "cut.stats", "cut off");
  fails({"--merge", base(), "-o", dir_ / "no.dam"}, "base.dam", "not a file of sums");
  fails({"--merge", dir_ / "none.stats", "-o", dir_ / "no.dam"}, "none.stats", "cannot open");
}

TEST(TrainAlone, OptionsThatDoNotGoTogether) {
  const TempDir dir;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {corpus()},
           {"-o", dir / "no.dam"},
           {corpus(), "--accumulate", dir / "x.stats", "-o", dir / "no.dam"},
           {corpus(), "-o", dir / "no.dam", "--merge", dir / "a.stats"},
           {corpus(), "--accumulate", dir / "x.stats", "--merge", dir / "a.stats"},
           {corpus(), "-o", dir / "no.dam", "--dominance", dir / "base.dam"},
           {corpus(), "-o", dir / "no.dam", "--shard", "1/2"},
           {corpus(), "--accumulate", dir / "x.stats", "--shard", "3/2"},
           {corpus(), "--accumulate", dir / "x.stats", "--mpi"},
           {corpus(), "--mpi", "-o", dir / "no.dam", "--base", "builtin"},
           {corpus(), "--accumulate", dir / "x.stats", "--method", "dam-paper"}}) {
    const auto result = train(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_FALSE(std::filesystem::exists(dir / "no.dam"));
    EXPECT_FALSE(std::filesystem::exists(dir / "x.stats"));
  }
}

}  // namespace train_test
}  // namespace animeme
