// Small inputs that ask for much: a sentence and an option, within the memory that a small machine
// has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/program/commands.h"
#include "tests/support/folders.h"

namespace animeme {
namespace limits_test {

using test::animeme;
using test::spill;
using test::TempDir;
using ::testing::HasSubstr;

// OpenBLAS, which FFmpeg's libraries bring in on some machines, takes memory for each thread at its
// start, and tries for ever if there is none.
constexpr const char* kNoThreadsOfBlas = "export OPENBLAS_NUM_THREADS=1; ";

// The program with 300 MB for all its data.
test::ProgramResult in_small_memory(const std::vector<std::string>& arguments) {
  std::string command = kNoThreadsOfBlas + std::string("ulimit -d 300000; exec ") +
                        test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  for (const std::string& argument : arguments) command += " " + test::quoted(argument);
  return test::run_command({"sh", "-c", command});
}

void refused(const std::vector<std::string>& arguments, const char* why) {
  const auto result = in_small_memory(arguments);
  EXPECT_EQ(result.exit_code, 3) << arguments[0] << ": " << result.err;
  EXPECT_THAT(result.err, HasSubstr(why)) << arguments[0];
}

std::string gap_text(int last, int rate = 25) {
  std::string mask = "0 0 1";
  for (int i = 3; i < 68; ++i) mask += " 0";
  return "2.1 gap " + std::to_string(rate) + " 2\n" + mask + "\n0 5\n" + mask + "\n" +
         std::to_string(last) + " 6\n";
}

TEST(Limits, FramesFarApart) {
  const TempDir dir;
  spill(dir / "gap.fap", gap_text(999998));
  for (const char* out : {"a.csv", "a.json", "a.glb", "a.visemes.csv"}) {
    refused({"export", dir / "gap.fap", "-o", dir / out}, "--max-seconds");
  }
  refused({"view", dir / "gap.fap", "-o", dir / "a.html"}, "--max-seconds");
  refused({"plot", dir / "gap.fap", "-o", dir / "a.svg", "--to", "3"}, "--max-seconds");
  refused({"render", dir / "gap.fap", "--frame", "3", "-o", dir / "a.png"}, "--max-seconds");
  EXPECT_EQ(dir.count(), 1u);
  // What no frame has to be filled in for has no limit.
  EXPECT_EQ(in_small_memory({"encode", dir / "gap.fap", "-o", dir / "gap.fba"}).exit_code, 0);
  EXPECT_EQ(in_small_memory({"stats", dir / "gap.fba"}).exit_code, 0);
  refused({"export", dir / "gap.fba", "-o", dir / "a.csv"}, "--max-seconds");
  // An hour at most: frames cost time, seconds are what is limited.
  spill(dir / "gap.fap", gap_text(3600, 1));
  EXPECT_EQ(in_small_memory({"export", dir / "gap.fap", "-o", dir / "a.csv"}).exit_code, 0);
  refused({"export", dir / "gap.fap", "-o", dir / "a.csv", "--max-seconds", "60"}, "--max-seconds");
  spill(dir / "gap.fap", gap_text(110000));
  refused({"export", dir / "gap.fap", "-o", dir / "a.visemes.csv"}, "--max-seconds");
  EXPECT_EQ(in_small_memory(
                {"export", dir / "gap.fap", "-o", dir / "a.visemes.csv", "--max-seconds", "5000"})
                .exit_code,
            0);
}

TEST(Limits, PhonesOfADay) {
  const TempDir dir;
  spill(dir / "day.tsv", "start_s\tend_s\tphone\n0\t86400\tAA\n");
  for (const char* out : {"a.fap", "a.fba", "a.csv", "a.mp4"}) {
    refused({"speak", "--script", dir / "day.tsv", "-o", dir / out}, "--max-seconds");
  }
  refused({"export", dir / "day.tsv", "-o", dir / "a.visemes.json"}, "--max-seconds");
  EXPECT_EQ(dir.count(), 1u);
  spill(dir / "hour.tsv", "start_s\tend_s\tphone\n0\t3599\tAA\n");
  EXPECT_EQ(in_small_memory({"speak", "--script", dir / "hour.tsv", "-o", dir / "a.fba"}).exit_code,
            0);
  refused({"speak", "--script", dir / "hour.tsv", "--max-seconds", "60", "-o", dir / "b.fba"},
          "--max-seconds");
  const auto day = animeme({"follow"}, "0 1 AA\n1 86400 B\n");
  EXPECT_EQ(day.exit_code, 3);
  EXPECT_THAT(day.err, HasSubstr("standard input:2: the phone ends 86399 s after the last one"));
  const auto line = animeme({"follow"}, std::string(100000, 'x'));
  EXPECT_EQ(line.exit_code, 3);
  EXPECT_THAT(line.err, HasSubstr("standard input:1: a line of more than 4 kB"));
}

TEST(Limits, FilesThatNeverEndOrAreHoles) {
  const TempDir dir;
  spill(dir / "hole.fap", "");
  std::filesystem::resize_file(dir / "hole.fap", std::uintmax_t(4) << 30);
  for (const std::string& input : {std::string("/dev/zero"), dir / "hole.fap"}) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"info", input},
             {"encode", input, "-o", dir / "a.fba"},
             {"decode", input, "-o", dir / "a.fap"},
             {"import", input, "-o", dir / "a.fap"},
             {"export", input, "-o", dir / "a.csv"},
             {"view", input, "-o", dir / "a.html"},
             {"stats", input},
             {"speak", "--script", input, "-o", dir / "a.fba"},
             {"speak", "--text-file", input, "-o", dir / "a.fba"},
             {"speak", "--text", "hi", "--model", input, "-o", dir / "a.fba"},
             {"mux", input, input, "-o", dir / "a.mp4"}}) {
      const auto result = in_small_memory(arguments);
      EXPECT_EQ(result.exit_code, 3) << arguments[0] << " " << input << ": " << result.err;
    }
    for (const char* name : {"head.glb", "head.vrm", "head.gltf", "head.fdp", "head.xmt"}) {
      std::filesystem::create_symlink(input, dir / name);
      const auto result = in_small_memory({"head", dir / name});
      EXPECT_EQ(result.exit_code, 3) << name << " " << input << ": " << result.err;
      std::filesystem::remove(dir / name);
    }
  }
  EXPECT_EQ(dir.count(), 1u);
}

TEST(Limits, NoMemoryIsASentence) {
  const TempDir dir;
  spill(dir / "gap.fap", gap_text(10000));
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  // Whoever runs out first, the main thread or a helper: neither aborts.
  for (const char* limit : {"40000", "46000", "55000"}) {
    for (const std::string& command :
         {" render " + test::quoted(dir / "gap.fap") + " --sheet 8x8 -o " +
              test::quoted(dir / "a.png"),
          " view " + test::quoted(dir / "gap.fap") + " -o " + test::quoted(dir / "a.html"),
          " export " + test::quoted(dir / "gap.fap") + " -o " + test::quoted(dir / "a.csv")}) {
      const auto result = test::run_command(
          {"sh", "-c",
           kNoThreadsOfBlas + std::string("ulimit -d ") + limit + "; exec " + program + command});
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 4)
          << limit << command << ": " << result.exit_code << result.err;
      if (result.exit_code == 4) {
        EXPECT_THAT(result.err, HasSubstr("not enough memory"));
      }
    }
  }
}

}  // namespace limits_test
}  // namespace animeme
