// What is written over nothing that is read, and under names that fit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <thread>

#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"

namespace animeme {
namespace outputs_test {

namespace fs = std::filesystem;
using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using ::testing::HasSubstr;

void refused(const std::vector<std::string>& arguments, const char* why) {
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 2) << arguments[0] << ": " << result.err;
  EXPECT_THAT(result.err, HasSubstr(why)) << arguments[0];
}

std::string plain() { return (test::data_dir() / "fap" / "plain.fap").string(); }

TEST(Outputs, WhatIsReadIsNotWrittenOver) {
  const TempDir dir;
  const std::string text = dir / "p.fap", stream = dir / "p.fba", film = dir / "p.mp4";
  spill(text, slurp(plain()));
  test::succeeds({"encode", text, "-o", stream});
  test::succeeds({"speak", "--text", "hi", "-o", film});
  fs::create_symlink(text, dir / "link.fba");
  fs::create_hard_link(text, dir / "hard.bin");
  fs::create_directory(dir / "sub");
  const std::string before = slurp(text), film_before = slurp(film), stream_before = slurp(stream);
  for (const std::string& name :
       {text, dir / "link.fba", dir / "hard.bin", dir / "sub/../hard.bin"}) {
    const auto result = animeme({"encode", text, "-o", name});
    EXPECT_EQ(result.exit_code, 2) << name << result.err;
  }
  refused({"decode", film, "-o", film}, "must end in .fap");
  refused({"mux", stream, film, "-o", film}, "is also what");
  refused({"demux", film, "--audio", film}, "is also what");
  refused({"demux", film, "--face", dir / "a.fba", "--audio", dir / "a.fba"}, "the same file");
  refused({"import", text, "-o", text}, "is also what");
  refused({"speak", "--text", "hi", "-o", dir / "n.mp4", "--preview", dir / "sub/../n.mp4"},
          "the same file");
  EXPECT_EQ(slurp(text), before);
  EXPECT_EQ(slurp(film), film_before);
  EXPECT_EQ(slurp(stream), stream_before);
}

TEST(Outputs, AFolderOfSegmentsDoesNotReplaceItsOwnInput) {
  const TempDir dir;
  test::succeeds({"encode", plain(), "-o", dir / "p.fba"});
  test::succeeds({"speak", "--text", "hi", "-o", dir / "p.mp4"});
  test::succeeds({"mux", dir / "p.fba", dir / "p.mp4", "-o", dir / "a.m3u8"});
  fs::create_directory(dir / "b_hls");
  fs::copy(dir / "p.fba", dir / "b_hls/face.m4s");
  refused({"mux", dir / "b_hls/face.m4s", dir / "p.mp4", "-o", dir / "b.m3u8"},
          "replaces the folder");
  EXPECT_TRUE(fs::exists(dir / "b_hls/face.m4s"));
  test::succeeds({"mux", dir / "p.fba", dir / "p.mp4", "-o", dir / "a.m3u8"});  // once more
}

TEST(Outputs, EndingsFitWhatIsWritten) {
  const TempDir dir;
  const std::string in = plain();
  refused({"encode", in, "-o", dir / "a.mp4"}, "must end in .fba");
  refused({"decode", in, "-o", dir / "a.mp4"}, "must end in .fap");
  refused({"decode", in, "--bap", dir / "a.fba"}, "must end in .bap");
  refused({"import", in, "-o", dir / "a.wav"}, "must end in .fap");
  refused({"demux", in, "--face", dir / "a.mp4"}, "must end in .fba");
  refused({"view", in, "-o", dir / "a.mp4"}, "must end in .html");
  refused({"train", ".", "-o", dir / "a.fap"}, "must end in .dam");
  refused({"align", "--audio", in, "--transcript", "x", "-o", dir / "a.txt"},
          ".TextGrid, .tsv, .pho, .vtt or .srt");
  refused({"speak", "--text", "hi", "-o", dir / "a.fap", "--save-script", dir / "a.lab"},
          "must end in .TextGrid, .tsv, .pho, .vtt or .srt");
  refused({"speak", "--text", "hi", "-o", dir / "a"}, "must end in .mp4");
  // What tells nobody what to write, where the ending would.
  refused({"speak", "--text", "hi", "-o", "-"}, "must end in .mp4");
  refused({"speak", "--text", "hi", "-o", dir / "a.fap", "--save-script", "-"},
          ".TextGrid, .tsv, .pho, .vtt or .srt");
  refused({"evaluate", "x", "y", "--picture", "-"}, "must end in .svg, .pdf or .png");
  refused({"head", "woman", "-o", "-"}, ".fdp, .xmt, .glb or .obj");
  refused({"render", in, "--frame", "0", "-o", dir / "a"}, "must end in .png");
  refused({"plot", in, "-o", dir / "a"}, "must end in .svg, .pdf or .png");
  refused({"align", "--audio", in, "--transcript", "x", "-o", dir / "a"},
          ".TextGrid, .tsv, .pho, .vtt or .srt");
  refused({"receive", "udp://127.0.0.1:9", "-o", dir / "a"}, "must end in .fap");
  refused({"check", dir.path().string(), "--json", dir / "a.mp4"}, "must end in .json");
  refused({"check", dir.path().string(), "--junit", dir / "a.json"}, "must end in .xml");
  refused({"plot", in, "-o", dir / "a.jpg"}, "must end in .svg, .pdf or .png");
  refused({"head", "woman", "-o", dir / "a.stl"}, ".fdp, .xmt, .glb or .obj");
  refused({"evaluate", "x", "y", "--picture", dir / "a.txt"}, "must end in .svg, .pdf or .png");
  EXPECT_EQ(dir.count(), 0u);
  test::succeeds({"encode", in, "-o", "/dev/null"});
  test::succeeds({"encode", in, "-o", dir / "no_ending"});
}

TEST(Outputs, APointListBesideAHeadIsNotWrittenOver) {
  const TempDir dir;
  test::succeeds({"head", "child", "-o", dir / "child.obj"});
  const std::string points = slurp(dir / "child.points.csv");
  fs::create_directory(dir / "in");
  fs::rename(dir / "child.obj", dir / "in/child.obj");
  const auto result = animeme({"head", dir / "in/child.obj", "--points", dir / "child.points.csv",
                               "-o", dir / "child.obj"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("written beside the output"));
  EXPECT_EQ(slurp(dir / "child.points.csv"), points);
  EXPECT_FALSE(fs::exists(dir / "child.obj"));
}

// A planted link at a name that can be foreseen would let another user's file be overwritten.
TEST(Outputs, NoForeseeableName) {
  const TempDir dir;
  spill(dir / "precious", "precious");
  const std::string program = std::string(test::kBinaryFolder) + "/bin/animeme";
  for (const auto& [command, ending] : {std::pair{"encode", ".fba"}, std::pair{"view", ".html"}}) {
    // The shell knows the number that the program will have, as an attacker may guess it.
    const std::string out = (dir / "a") + ending;
    const auto result =
        test::run_command({"sh", "-c",
                           "for n in .part .part$$ .part0 .tmp; do ln -s precious " +
                               test::quoted(out) + "$n; done; exec " + test::quoted(program) + " " +
                               command + " " + test::quoted(plain()) + " -o " + test::quoted(out)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(slurp(dir / "precious"), "precious");
  }
}

}  // namespace outputs_test
}  // namespace animeme
