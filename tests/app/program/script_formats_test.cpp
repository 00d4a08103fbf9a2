// Scripts of other programs through the commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/script/script.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace script_formats_test {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;

std::string script(const std::string& name) {
  return (test::data_dir() / "scripts/formats" / name).string();
}

TEST(ScriptFormats, AreSpokenAndWrittenByTheirEnding) {
  const TempDir dir;
  for (const char* ending : {".TextGrid", ".tsv", ".pho", ".vtt", ".srt"}) {
    test::succeeds({"speak", "--script", script("gentle.json"), "-o", dir / "a.fap",
                    "--save-script", dir / "a" + ending});
  }
  EXPECT_THAT(test::slurp(dir / "a.TextGrid"), HasSubstr("IntervalTier"));
  EXPECT_THAT(test::slurp(dir / "a.tsv"), HasSubstr("0.25\t0.3\tB\tbin\n"));
  EXPECT_THAT(test::slurp(dir / "a.pho"), HasSubstr("\nB 50\n"));
  EXPECT_THAT(test::slurp(dir / "a.vtt"), HasSubstr("\n<00:00:00.250>bin<00:00:00.500> "));
  const auto again = dam::read_script(test::slurp(dir / "a.pho"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->phones.size(), 8u);
}

TEST(ScriptFormats, TierAndFormatAreChosen) {
  const TempDir dir;
  const std::vector<std::string> speak = {"speak", "-o", dir / "a.fap", "--script"};
  const auto said = [&](std::vector<std::string> more) {
    std::vector<std::string> all = speak;
    all.insert(all.end(), more.begin(), more.end());
    const auto result = animeme(all);
    EXPECT_NE(result.exit_code, 0);
    return result.err;
  };
  EXPECT_THAT(said({script("htk.mlf"), "--tier", "s2"}), HasSubstr("\"*/s1.lab\""));
  EXPECT_THAT(said({script("short.TextGrid"), "--tier", "mouth"}), HasSubstr("\"phones\""));
  EXPECT_THAT(said({script("short.TextGrid"), "--script-format", "help"}), HasSubstr("elevenlabs"));
  EXPECT_THAT(said({script("short.TextGrid"), "--script-format", "htk@x"}),
              HasSubstr("timit@8000"));
  EXPECT_THAT(said({script("short.TextGrid"), "--script-format", "htk"}), HasSubstr(":1:"));
  test::succeeds({"speak", "-o", dir / "b.fap", "--script", script("timit.phn"), "--script-format",
                  "timit@8000"});
  test::succeeds({"export", script("timit.phn"), "-o", dir / "a.visemes.json"});
  test::succeeds({"export", script("polly.json"), "-o", dir / "a.tsv", "--what", "rhubarb"});
  for (const char* name : {"words.srt", "karaoke.vtt", "mbrola.pho", "audacity.txt"}) {
    EXPECT_THAT(animeme({"info", script(name)}).out, HasSubstr("kind: script")) << name;
  }
}

}  // namespace script_formats_test
}  // namespace animeme
