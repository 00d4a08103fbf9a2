// The commands of dam/tutorial.md run as they stand, one after the other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dam/model/model.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace tutorial_test {

namespace fs = std::filesystem;

TEST(Tutorial, EachCommandRuns) {
  const fs::path root = data_dir().parent_path().parent_path();
  const std::string commands = fenced_commands(slurp(root / "dam/tutorial.md"));
  ASSERT_THAT(commands, ::testing::HasSubstr("animeme train me"));
  const TempDir dir;
  spill(dir / "commands.sh",
        "set -eu\ncd " + quoted(dir.path().string()) +
            "\nPATH=" + quoted(std::string(test::kBinaryFolder) + "/bin") + ":$PATH SAMPLE=" +
            quoted((data_dir() / "grid_s1_sample").string()) + "\nexport PATH SAMPLE\n" + commands);
  const auto result = run_command({"sh", "-x", dir / "commands.sh"});
  if (result.err.find("built without") != std::string::npos) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // It did what the text says.
  for (const char* name : {"me/report.txt", "diary/fap/diary_001.csv", "sentence.svg", "me.html",
                           "curves.svg", "talk.mp4", "talk.livelink.csv", "expressive.fba",
                           "talk.png", "talking_man.glb", "fits.csv"}) {
    EXPECT_GT(fs::file_size(dir / name), 0u) << name;
  }
  const auto model = dam::load_model(dir / "diary.dam");
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_TRUE(dam::load_model(dir / "avatar.dam"));
}

}  // namespace tutorial_test
}  // namespace animeme::test
