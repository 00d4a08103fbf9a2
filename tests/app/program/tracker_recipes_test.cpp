// The recipes of tools/characters/trackers with real trackers, on heads of ours that are drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dam/corpus/corpus.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"
#include "tests/support/tracked_head.h"

namespace animeme {
namespace tracker_recipes_test {

namespace fs = std::filesystem;

using test::animeme;
using test::has_program;
using test::slurp;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;

const fs::path kRecipes = fs::path(test::kSourceFolder) / "tools/characters/trackers";
const fs::path kClip = test::data_dir() / "grid_s1_sample/fap/pbwdzp.csv";  // P B M in it

TEST(TrackerRecipes, MediapipeSeesWhatIsDrawn) {
  if (!has_program("node")) GTEST_SKIP() << "node is not installed (Debian package nodejs)";
  if (!has_program("chromium")) GTEST_SKIP() << "chromium is not installed (Debian package)";
  if (!has_program("ffprobe")) GTEST_SKIP() << "ffmpeg is not installed (Debian package)";
  if (!fs::exists(kRecipes / "mediapipe/node_modules/@mediapipe/face_mesh")) {
    GTEST_SKIP() << "npm @mediapipe/face_mesh is not installed: tools/setup.sh full";
  }
  const TempDir dir;
  const auto film = animeme({"render", kClip.string(), "--head", "woman", "--size", "384x384",
                             "--zoom", "1.4", "-o", dir / "talk.mp4"});
  if (film.err.find("built without") != std::string::npos) GTEST_SKIP() << film.err;
  ASSERT_EQ(film.exit_code, 0) << film.err;
  const std::string track = "node '" + (kRecipes / "mediapipe/track.js").string() + "'";
  const auto import =
      animeme({"import", dir / "talk.mp4", "--tracker", track, "-o", dir / "seen.csv"});
  ASSERT_EQ(import.exit_code, 0) << import.err;
  const auto drawn = dam::read_curves(slurp(kClip.string()));
  const auto seen = dam::read_curves(slurp(dir / "seen.csv"));
  ASSERT_TRUE(drawn && seen);
  EXPECT_EQ(seen->rate.frames_per_second(), drawn->rate.frames_per_second());
  ASSERT_EQ(seen->frames(), drawn->frames()) << import.err;
  // 0.88 and 0.97; where a face has 150 pixels, small changes of its skin count as much.
  EXPECT_GT(test::agreement(test::curve_of(*drawn, 3), test::curve_of(*seen, 3)).correlation, 0.85);
  EXPECT_GT(test::agreement(test::lip_gap(*drawn), test::lip_gap(*seen)).correlation, 0.9);
}

}  // namespace tracker_recipes_test
}  // namespace animeme
