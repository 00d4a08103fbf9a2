// `animeme import` of several captures, with neutral faces of others, and of videos by a tracker.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dam/corpus/corpus.h"
#include "tests/app/program/commands.h"
#include "tests/support/landmark_tables.h"
#include "tests/support/shared.h"

namespace animeme {
namespace capture_test {

using test::acted;
using test::animeme;
using test::expect_faps;
using test::import;
using test::mediapipe;
using test::read_clip;
using test::sixty_eight;
using test::spill;
using test::succeeds;
using test::TempDir;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string plain_name(int i, char axis) { return std::string(1, axis) + std::to_string(i); }

// The rows of a table from `first` on, `count` of them.
std::string part(const std::string& table, std::size_t first, std::size_t count) {
  std::string out;
  std::size_t begin = 0;
  for (std::size_t line = 0; begin < table.size(); ++line) {
    const std::size_t end = table.find('\n', begin) + 1;
    if (line == 0 || (line > first && line <= first + count)) {
      out += table.substr(begin, end - begin);
    }
    begin = end;
  }
  return out;
}

// A program that stands for a tracker: shell, with the video as $1 and the table as $2.
std::string tracker(const TempDir& dir, const std::string& script) {
  spill(dir / "track.sh", script);
  return "sh '" + dir / "track.sh" + "' {in} {out}";
}

std::string video() { return (test::data_dir() / "containers/mpeg4_video.mp4").string(); }

TEST(Captures, AFaceFileIsTheNeutralFaceOfOthers) {
  const TempDir dir;
  const std::string table = mediapipe(10, 478);
  spill(dir / "whole.csv", table);
  spill(dir / "later.csv", part(table, 4, 6));  // never at rest
  const std::vector<std::string> usual = {"--size", "1280x720", "--smooth", "0", "--exact"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "import");
    arguments.insert(arguments.end(), usual.begin(), usual.end());
    return animeme(arguments);
  };
  const auto saved = run({dir / "whole.csv", "--neutral", "0", "--save-face", dir / "me.face", "-o",
                          dir / "whole.fap"});
  ASSERT_EQ(saved.exit_code, 0) << saved.err;
  for (const std::vector<std::string>& neutral :
       {std::vector<std::string>{"--face-file", dir / "me.face"},
        {"--neutral-from", dir / "whole.csv", "--neutral", "0"}}) {
    std::vector<std::string> arguments = {dir / "later.csv", "-o", dir / "later.fap"};
    arguments.insert(arguments.end(), neutral.begin(), neutral.end());
    const auto later = run(arguments);
    ASSERT_EQ(later.exit_code, 0) << later.err;
    const auto clip = read_clip(dir / "later.fap");
    expect_faps(clip, {3, 5, 12, 18, 19, 23, 24, 31, 48, 49, 50}, 1,
                [](int i) { return acted(i + 4); });
  }
  // The same face again, whoever writes it.
  const auto again = run({dir / "later.csv", "--face-file", dir / "me.face", "--save-face",
                          dir / "again.face", "-o", dir / "later.fap"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(test::slurp(dir / "again.face"), test::slurp(dir / "me.face"));
}

TEST(Captures, SeveralHaveOneNeutralFace) {
  const TempDir dir;
  const std::string table = mediapipe(12, 478);
  spill(dir / "a.csv", part(table, 0, 6));
  spill(dir / "b.csv", part(table, 6, 6));  // the lips do not close there
  const auto result = animeme({"import", dir / "a.csv", dir / "b.csv", "--size", "1280x720", "-o",
                               dir / "out/", "--save-face", dir / "me.face", "--exact"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const fap::Sequence a = read_clip(dir / "out/a.fap");
  const fap::Sequence b = read_clip(dir / "out/b.fap");
  ASSERT_EQ(a.frames.size(), 6U);
  ASSERT_EQ(b.frames.size(), 6U);
  // One scale: the jaw goes on opening where the other clip ends, 20 units a frame.
  EXPECT_NEAR(b.frames[0].value[3] - a.frames[0].value[3], 120, 12);
  EXPECT_NEAR(b.frames[5].value[3] - b.frames[0].value[3], 100, 12);
  const auto alone =
      animeme({"import", dir / "b.csv", "--size", "1280x720", "-o", dir / "alone.fap", "--exact"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_LT(read_clip(dir / "alone.fap").frames[0].value[3], 60)
      << "alone it has a face of its own";
}

TEST(Captures, WhereSeveralGo) {
  const TempDir dir;
  const std::string table = sixty_eight(6, plain_name);
  spill(dir / "a.csv", table);
  spill(dir / "b.csv", table);
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"import", dir / "a.csv", dir / "b.csv", "--rate", "25"});
    return animeme(arguments);
  };
  const auto one_file = run({"-o", dir / "out.fap"});
  EXPECT_EQ(one_file.exit_code, 2);
  EXPECT_THAT(one_file.err, HasSubstr("is one file for 2 inputs; name a folder"));
  const auto part_of_which = run({"-o", dir / "out/", "--neutral", "0"});
  EXPECT_EQ(part_of_which.exit_code, 3);
  EXPECT_THAT(part_of_which.err, HasSubstr("select one with --neutral-from"));
  const auto twice = animeme({"import", dir / "a.csv", dir / "a.csv", "-o", dir / "out/"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("two inputs would be written to"));
  // A corpus has its curves in fap/.
  std::filesystem::create_directories(dir / "corpus");
  spill(dir / "corpus/utterances.tsv", "id\ttext\na\thello\nb\tworld\n");
  ASSERT_EQ(run({"-o", dir / "corpus"}).exit_code, 0);
  const auto curves = dam::read_curves(test::slurp(dir / "corpus/fap/b.csv"));
  ASSERT_TRUE(curves) << curves.error().describe();
  EXPECT_EQ(curves->frames(), 6U);
}

TEST(Captures, CurvesSayWhatWasMeasured) {
  const TempDir dir;
  const std::string table = mediapipe(12, 478);
  spill(dir / "gap.csv", part(table, 0, 5) + part(table, 7, 5).substr(table.find('\n') + 1));
  succeeds({"import", dir / "gap.csv", "--size", "1280x720", "--neutral", "0", "-o",
            dir / "gap.csv.csv"});
  const auto curves = dam::read_curves(test::slurp(dir / "gap.csv.csv"));
  ASSERT_TRUE(curves) << curves.error().describe();
  ASSERT_EQ(curves->frames(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(curves->measured[i], i != 5 && i != 6) << i;
  EXPECT_NEAR(curves->at(6, 0), 120, 3) << "on the line between 80 and 140";
}

TEST(Captures, NamesOfOthersByAMap) {
  const TempDir dir;
  spill(dir / "take.csv", "clock;mouth;noise\n0;0;7\n0,04;50;7\n0,08;100;7\n");
  spill(dir / "map.csv", "column,meaning,factor\n# seconds\nclock,time_s\nmouth,jawOpen,0.01\n");
  succeeds(
      {"import", dir / "take.csv", "--columns", dir / "map.csv", "--exact", "-o", dir / "a.fap"});
  const fap::Sequence shapes = read_clip(dir / "a.fap");
  ASSERT_EQ(shapes.frames.size(), 3U);
  EXPECT_EQ(shapes.frames[2].value[3], 1360);
  succeeds({"import", dir / "take.csv", "--column", "clock=time_s", "--column", "mouth=fap3*2",
            "--column", "noise=-", "--exact", "-o", dir / "b.fap"});
  const fap::Sequence faps = read_clip(dir / "b.fap");
  ASSERT_EQ(faps.frames.size(), 3U);
  EXPECT_EQ(faps.frames[2].value[3], 200);
  const auto wrong =
      animeme({"import", dir / "take.csv", "--column", "mouth=jawOpn", "-o", dir / "c.fap"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--column mouth=jawOpn: 'jawOpn' is not a known meaning"));
}

TEST(Captures, AVideoWantsATracker) {
  const TempDir dir;
  const auto bare = animeme({"import", video(), "-o", dir / "a.fap"});
  EXPECT_EQ(bare.exit_code, 3);
  EXPECT_THAT(bare.err,
              AllOf(HasSubstr("this is a video (mpeg4, 64x48, 10 frames a second, 0.5 s)"),
                    HasSubstr("--tracker \"command {in} {out}\"")));
  const auto sound = animeme(
      {"import", (test::data_dir() / "containers/fba_aac.mkv").string(), "-o", dir / "a.fap"});
  EXPECT_EQ(sound.exit_code, 3);
}

TEST(Captures, ATrackerOfOthers) {
  const TempDir dir;
  spill(dir / "table.csv", mediapipe(10, 478, 640, 480));
  const std::string copy =
      tracker(dir, "echo looking >&2; cp '" + dir / "table.csv" + "' \"$2\"\n");
  succeeds({"import", video(), "--tracker", copy, "--neutral", "0", "--smooth", "0", "--exact",
            "-o", dir / "a.fap"});
  // The shape of the picture is the video's: 64x48.
  expect_faps(read_clip(dir / "a.fap"), {3, 5, 12, 19, 31, 48, 49, 50}, 1);
  const std::string to_out = "cat '" + dir / "table.csv" + "' /dev/null {in}";
  const auto mixed = animeme({"import", video(), "--tracker", to_out, "-o", dir / "b.fap"});
  EXPECT_EQ(mixed.exit_code, 3) << "the video behind the table is no row of it";
}

TEST(Captures, TrackersThatFail) {
  const TempDir dir;
  const struct {
    std::string command;
    int exit_code;
    const char* what;
  } cases[] = {
      {"no_such_program {in} {out}", 2, "cannot find an executable program no_such_program"},
      {"true '{in}", 2, "not closed"},
      {"true {out}", 2, "has {out} and no {in}"},
      {tracker(dir, "echo no camera >&2; exit 7\n"), 3, "exit code 7; it said: no camera"},
      {"true {in} {out}", 3, "the tracker wrote no table"},
      {"echo {in}", 3, "not a table: its first line is one field"},
      {"sleep 30 {in}", 3, "exit code 1"},
  };
  for (const auto& one : cases) {
    const auto result = animeme({"import", video(), "--tracker", one.command, "-o", dir / "a.fap"});
    EXPECT_EQ(result.exit_code, one.exit_code) << one.command << result.err;
    EXPECT_THAT(result.err, HasSubstr(one.what)) << one.command;
    EXPECT_FALSE(std::filesystem::exists(dir / "a.fap"));
  }
  spill(dir / "slow.sh", "sleep 20\n");
  const auto slow =
      animeme({"import", video(), "--tracker", "sh " + dir / "slow.sh" + " {in} {out}",
               "--tracker-seconds", "0.2", "-o", dir / "a.fap"});
  EXPECT_EQ(slow.exit_code, 3);
  EXPECT_THAT(slow.err, HasSubstr("took more than 0.2 s"));
  // How far it was is not why it failed.
  const std::string far =
      tracker(dir, "printf '7 %%\\nno light\\nx: 42.5 %%\\r43 %%' >&2; exit 7\n");
  const auto dark = animeme({"import", video(), "--tracker", far, "-o", dir / "a.fap"});
  EXPECT_THAT(dark.err, HasSubstr("it said: no light\n"));
}

TEST(Captures, ATrackerIsStoppedByCtrlC) {
  const TempDir dir;
  // It interrupts the program that runs it, and would go on.
  const std::string kill =
      tracker(dir, "kill -INT $PPID; sleep 20; echo late >'" + dir / "late" + "'\n");
  const auto stopped = animeme({"import", video(), "--tracker", kill, "-o", dir / "a.fap"});
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "a.fap"));
  EXPECT_FALSE(std::filesystem::exists(dir / "late"));
}

// Lips alone, the head taken off by others: what a face file is needed for.
TEST(Captures, LipsAloneAgainstAFaceFile) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  const TempDir dir;
  const auto folder = test::shared_dir() / "data" / "grid_s1";
  succeeds({"import", (folder / "lips/bbal9a.csv").string(), "--face-file",
            (folder / "neutral.json").string(), "--smooth", "0", "-o", dir / "lips.csv"});
  const auto made = dam::read_curves(test::slurp(dir / "lips.csv"));
  const auto want = dam::read_curves(test::slurp(folder / "fap/bbal9a.csv"));
  ASSERT_TRUE(made && want);
  int compared = 0;
  for (std::size_t c = 0; c < made->names.size(); ++c) {
    for (std::size_t w = 0; w < want->names.size(); ++w) {
      if (made->names[c] != want->names[w]) continue;
      ++compared;
      for (std::size_t i = 0; i < want->frames(); ++i) {
        ASSERT_NEAR(made->at(i, c), want->at(i, w), 1.5) << made->names[c] << " " << i;
      }
    }
  }
  EXPECT_EQ(compared, 23);
}

}  // namespace capture_test
}  // namespace animeme
