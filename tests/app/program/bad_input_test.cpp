// Bad input: one clear sentence with file, line and remedy, exit code 3, and no output file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace bad_input_test {

using test::animeme;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::HasSubstr;

// Runs, and checks what every failure has in common.
test::ProgramResult fails(const TempDir& dir, std::vector<std::string> arguments) {
  const auto before = dir.files();
  const auto result = animeme(std::move(arguments));
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_TRUE(result.err.starts_with("animeme: error: ")) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_TRUE(result.out.empty()) << result.out;
  EXPECT_THAT(dir.files(), testing::UnorderedElementsAreArray(before));
  return result;
}

std::string tsv(const std::string& rows) { return "start_s\tend_s\tphone\n" + rows; }

// One second of silence as a WAV file.
std::string wav(int samples) {
  std::string data(std::size_t(samples) * 2, '\0');
  const auto u32 = [](std::uint32_t v) {
    return std::string{char(v), char(v >> 8), char(v >> 16), char(v >> 24)};
  };
  return "RIFF" + u32(std::uint32_t(36 + data.size())) + "WAVEfmt " + u32(16) +
         std::string("\1\0\1\0", 4) + u32(16000) + u32(32000) + std::string("\2\0\x10\0", 4) +
         "data" + u32(std::uint32_t(data.size())) + data;
}

TEST(BadInput, MissingFiles) {
  const TempDir dir;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"speak", "--script", "/nowhere/a.tsv", "-o", dir / "a.fap"},
           {"speak", "--text", "hi", "--model", "/nowhere/a.dam", "-o", dir / "a.fap"},
           {"encode", "/nowhere/a.fap", "-o", dir / "a.fba"},
           {"decode", "/nowhere/a.mp4", "-o", dir / "a.fap"},
           {"mux", "/nowhere/a.fap", "/nowhere/a.wav", "-o", dir / "a.mp4"},
           {"demux", "/nowhere/a.mp4", "--face", dir / "a.fba"},
           {"train", "/nowhere", "-o", dir / "a.dam"},
           {"evaluate", "builtin", "/nowhere"},
           {"info", "/nowhere/a"}}) {
    const auto result = fails(dir, arguments);
    EXPECT_THAT(result.err, HasSubstr("/nowhere")) << arguments[0];
  }
}

TEST(BadInput, EmptyText) {
  const TempDir dir;
  fails(dir, {"speak", "--text", "", "-o", dir / "a.mp4"});
  fails(dir, {"speak", "--text", "  \n ", "-o", dir / "a.mp4"});
  fails(dir, {"speak", "--text", "hello", "--lang", "klingonese", "-o", dir / "a.mp4"});
}

TEST(BadInput, Scripts) {
  const TempDir dir;
  struct Case {
    const char* rows;
    const char* line;
    const char* word;
  };
  for (const Case& one : {
           Case{"0\t0.5\tSIL\n0.5\t0.7\tQQ\n", ":3:", "QQ"},
           Case{"0\t0.5\tSIL\n0.4\t0.7\tAA\n", ":3:", "AA"},
           Case{"0\t0.5\tAA\n0.7\t0.6\tP\n", ":3:", "P"},
           Case{"0.5\t0.9\tAA\n0.1\t0.2\tP\n", ":3:", "P"},
           Case{"0\tx\tAA\n", ":2:", "x"},
           Case{"0\t0.5\n", ":2:", ""},
       }) {
    spill(dir / "s.tsv", tsv(one.rows));
    const auto result = fails(dir, {"speak", "--script", dir / "s.tsv", "-o", dir / "a.fap"});
    EXPECT_THAT(result.err, AllOf(HasSubstr("s.tsv"), HasSubstr(one.line), HasSubstr(one.word)))
        << one.rows;
  }
  spill(dir / "s.tsv", "");
  fails(dir, {"speak", "--script", dir / "s.tsv", "-o", dir / "a.fap"});
}

TEST(BadInput, AudioShorterThanTheScript) {
  const TempDir dir;
  spill(dir / "s.tsv", tsv("0\t0.5\tSIL\n0.5\t2.5\tAA\n"));
  spill(dir / "a.wav", wav(16000));
  const auto result = fails(
      dir, {"speak", "--script", dir / "s.tsv", "--audio", dir / "a.wav", "-o", dir / "a.mp4"});
  EXPECT_THAT(result.err, AllOf(HasSubstr("s.tsv"), HasSubstr("2.5"), HasSubstr("1")));
}

TEST(BadInput, AudioThatIsNone) {
  const TempDir dir;
  spill(dir / "s.tsv", tsv("0\t0.5\tAA\n"));
  spill(dir / "a.wav", "this is not sound at all");
  const auto result = fails(
      dir, {"speak", "--script", dir / "s.tsv", "--audio", dir / "a.wav", "-o", dir / "a.mp4"});
  EXPECT_THAT(result.err, HasSubstr("a.wav"));
}

TEST(BadInput, CorruptModel) {
  const TempDir dir;
  const std::string good = test::slurp(std::filesystem::path(test::kSourceFolder) / "dam" /
                                       "model" / "builtin" / "grid_s1.dam");
  ASSERT_GT(good.size(), 1000u);
  std::string bad = good;
  bad[bad.size() / 2] = char(bad[bad.size() / 2] ^ 1);
  spill(dir / "bad.dam", bad);
  spill(dir / "short.dam", good.substr(0, good.size() / 2));
  spill(dir / "other.dam", "hello");
  for (const char* name : {"bad.dam", "short.dam", "other.dam"}) {
    const auto result =
        fails(dir, {"speak", "--text", "hi", "--model", dir / name, "-o", dir / "a.fap"});
    EXPECT_THAT(result.err, HasSubstr(name));
  }
}

TEST(BadInput, TruncatedAndForeignStreams) {
  const TempDir dir;
  ASSERT_EQ(animeme({"speak", "--text", "Hello world", "-o", dir / "a.fba"}).exit_code, 0);
  const std::string stream = test::slurp(dir / "a.fba");
  spill(dir / "cut.fba", stream.substr(0, stream.size() / 2));
  const auto result = fails(dir, {"decode", dir / "cut.fba", "-o", dir / "b.fap", "--strict"});
  EXPECT_THAT(result.err, AllOf(HasSubstr("cut.fba"), HasSubstr("bit "), HasSubstr("ends")));
  spill(dir / "text.fba", "hello");
  fails(dir, {"decode", dir / "text.fba", "-o", dir / "b.fap"});
  spill(dir / "empty.fba", "");
  fails(dir, {"decode", dir / "empty.fba", "-o", dir / "b.fap"});
  spill(dir / "noise.mp4", std::string(3000, '\7'));
  fails(dir, {"decode", dir / "noise.mp4", "-o", dir / "b.fap"});
}

TEST(BadInput, FapText) {
  const TempDir dir;
  spill(dir / "a.fap", "2.1 x 25 1\n0 0 1\n0 5\n");
  const auto result = fails(dir, {"encode", dir / "a.fap", "-o", dir / "a.fba"});
  EXPECT_THAT(result.err, HasSubstr("a.fap:3:3:"));
}

TEST(BadInput, OutputThatCannotBeWritten) {
  const TempDir dir;
  fails(dir, {"speak", "--text", "hi", "-o", dir / "no/such/folder/a.mp4"});
  fails(dir, {"speak", "--text", "hi", "-o", dir / "no/such/folder/a.fap"});
}

TEST(BadInput, LeavesNoScriptBehindEither) {
  const TempDir dir;
  fails(dir, {"speak", "--text", "hi", "-o", dir / "no/such/folder/a.fap", "--save-script",
              dir / "a.TextGrid"});
}

TEST(BadInput, KeepsTheOldFileWhenItFails) {
  const TempDir dir;
  spill(dir / "a.mp4", "precious");
  const auto result =
      animeme({"speak", "--text", "hi", "--model", dir / "none", "-o", dir / "a.mp4"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(test::slurp(dir / "a.mp4"), "precious");
}

TEST(Info, ReadsStandardInputOnce) {
  const auto text = test::slurp(test::data_dir() / "fap" / "plain.fap");
  const auto result = animeme({"info", "-"}, text);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("kind: fap"));
}

TEST(Usage, IsExitCode2) {
  const TempDir dir;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {},
           {"sing"},
           {"speak", "--text", "hi"},
           {"speak", "-o", dir / "a.mp4"},
           {"speak", "--text", "hi", "-o", dir / "a.avi"},
           {"speak", "--text", "hi", "--rate", "fast", "-o", dir / "a.mp4"},
           {"encode", "a.fap", "--quant", "32", "-o", "b.fba"},
           {"decode", "a.fba", "--frobnicate", "-o", "b.fap"},
           {"demux", "a.mp4"}}) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_FALSE(result.err.empty());
  }
  EXPECT_TRUE(dir.files().empty());
}

TEST(Usage, HelpFitsAndHasExamples) {
  for (const char* command :
       {"speak", "align", "train", "evaluate", "encode", "decode", "mux", "demux", "info",
        "compare", "check", "stats", "plot", "render", "stream", "follow"}) {
    const auto result = animeme({command, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("Examples:\n  animeme ")) << command;
    EXPECT_LT(std::count(result.out.begin(), result.out.end(), '\n'), 100) << command;
  }
  EXPECT_THAT(animeme({"--version"}).out, HasSubstr("animeme 0."));
  const std::string all = animeme({"stream", "--help-all"}).out;
  EXPECT_THAT(all, HasSubstr("--mtu"));
  EXPECT_THAT(all, HasSubstr("--say-audio"));
}

}  // namespace bad_input_test
}  // namespace animeme
