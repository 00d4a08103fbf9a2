// The commands of tools/dubbing.md run as they stand, one after the other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace dubbing_test {

namespace fs = std::filesystem;

TEST(Dubbing, EachCommandRuns) {
  const std::string commands = fenced_commands(slurp(fs::path(kSourceFolder) / "tools/dubbing.md"));
  ASSERT_THAT(commands, ::testing::HasSubstr("animeme mux"));
  const TempDir dir;
  spill(dir / "commands.sh", "set -eu\ncd " + quoted(dir.path().string()) +
                                 "\nPATH=" + quoted(std::string(kBinaryFolder) + "/bin") +
                                 ":$PATH\nexport PATH\n" + commands);
  const auto result = run_command({"sh", "-x", dir / "commands.sh"});
  if (result.err.find("built without") != std::string::npos) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name :
       {"en.srt", "film.mp4", "again.wav", "again.TextGrid", "fr.html", "ja.csv"})
    EXPECT_GT(fs::file_size(dir / name), 0u) << name;
  // Each cue is in its time, or its row tells that it is not.
  for (const char* language : {"de", "fr", "ja", "ar"}) {
    const Json said = Json::parse(slurp(dir / (std::string(language) + ".json")));
    ASSERT_EQ(said["cues"].size(), 3u) << language;
    for (const Json& cue : said["cues"]) {
      const double speed = cue["speed"], end = double(cue["said"]) + double(cue["seconds"]);
      EXPECT_GE(speed, 0.8);
      EXPECT_LE(speed, 1.3);
      if (cue["cut_characters"] == 0) {
        EXPECT_LE(end, double(cue["end"]) + 0.03) << language << ": " << cue;
      } else {
        EXPECT_GT(double(cue["late"]), 0) << language << ": " << cue;
      }
    }
    EXPECT_GT(said["over"]["moments"].size(), 1u);
  }
  const Json info = json_of({"info", dir / "film.mp4"});
  std::string languages;
  for (const Json& track : info["tracks"]) {
    if (track["kind"] == "face") languages += track.value("language_tag", "") + " ";
  }
  EXPECT_EQ(languages, "en de fr ja ar ");
  succeeds({"demux", dir / "de.mp4", "-o", dir / "alone.fba"});
  EXPECT_EQ(slurp(dir / "again.fba"), slurp(dir / "alone.fba"));
}

}  // namespace dubbing_test
}  // namespace animeme::test
