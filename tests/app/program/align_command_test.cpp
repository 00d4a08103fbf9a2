// Alignment as a user has it: what is told of words that the text has and nobody says, and the
// other way round.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace animeme {
namespace align_command_test {

using nlohmann::json;
using test::animeme;
using test::TempDir;
using testing::HasSubstr;

constexpr const char* kText = "please put the small blue book on the table by the window";

test::ProgramResult align(const TempDir& dir, const std::string& text,
                          std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"align",  "--audio", dir / "voice.mp4", "--transcript", text,
                                     "--json", "-o",      dir / "voice.tsv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return animeme(arguments);
}

// Empty, or why there is nothing to test.
std::string no_aligner(const TempDir& dir) {
  if (animeme({"speak", "--text", kText, "-o", dir / "voice.mp4"}).exit_code != 0)
    return "no voice";
  const auto out = align(dir, kText);
  return out.exit_code != 0 && out.err.find("install") != std::string::npos ? out.err : "";
}

TEST(AlignCommand, TellsWhatIsNotSaidAndWhatIsSaidMore) {
  const TempDir dir;
  if (const auto why = no_aligner(dir); !why.empty()) GTEST_SKIP() << why;
  const auto out = align(dir, "please put the small yesterday blue book on the table");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("'yesterday' is not said (between 'small' and 'blue'"));
  EXPECT_THAT(out.err, HasSubstr("there is speech that is not in the transcript (after 'table'"));
  const json found = json::parse(out.out);
  ASSERT_EQ(found["words"].size(), 10u);
  for (const json& word : found["words"]) {
    EXPECT_EQ(word["said"].get<bool>(), word["word"] != "yesterday") << word;
  }
  ASSERT_EQ(found["inserted"].size(), 1u);
  EXPECT_EQ(found["inserted"][0]["before_word"], 10);
  ASSERT_EQ(found["timed_phones"].size(), found["phones"].get<std::size_t>());
  double before = 0;
  for (const json& phone : found["timed_phones"]) {
    EXPECT_EQ(phone["start"].get<double>(), before);
    before = phone["end"];
  }
}

TEST(AlignCommand, MarksOfSoundsAreNoWords) {
  const TempDir dir;
  if (const auto why = no_aligner(dir); !why.empty()) GTEST_SKIP() << why;
  const auto plain = align(dir, kText);
  const auto marked = align(dir, "[noise] " + std::string(kText) + " (laughs)");
  ASSERT_EQ(marked.exit_code, 0) << marked.err;
  EXPECT_THAT(marked.err, HasSubstr("\"[noise]\" is not said (--speak-marks says such marks) (2"));
  EXPECT_EQ(json::parse(marked.out)["words"], json::parse(plain.out)["words"]);
  const auto said = align(dir, "[noise] " + std::string(kText), {"--speak-marks"});
  EXPECT_EQ(json::parse(said.out)["words"][0]["word"], "noise");
}

TEST(AlignCommand, MinConfidenceRefusesByName) {
  const TempDir dir;
  if (const auto why = no_aligner(dir); !why.empty()) GTEST_SKIP() << why;
  const auto sure = align(dir, kText, {"--min-confidence", "0.05"});
  EXPECT_EQ(sure.exit_code, 0) << sure.err;
  const auto unsure =
      align(dir, "please put the small yesterday blue book on the table by the window",
            {"--min-confidence", "0.05"});
  EXPECT_EQ(unsure.exit_code, 3);
  EXPECT_THAT(unsure.err, HasSubstr("words below --min-confidence: yesterday"));
  const auto other = align(dir, "nine years ago our uncle never knew how many letters she wrote");
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("does not fit the recording"));
}

TEST(AlignCommand, SpeakRefusesByMinConfidenceToo) {
  const TempDir dir;
  if (const auto why = no_aligner(dir); !why.empty()) GTEST_SKIP() << why;
  const auto speak = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"speak", "--audio", dir / "voice.mp4", "-o", dir / "talk.fba"};
    all.insert(all.end(), more.begin(), more.end());
    return animeme(all);
  };
  const auto unsure = speak({"--min-confidence", "0.99"});
  EXPECT_EQ(unsure.exit_code, 3);
  EXPECT_THAT(unsure.err, HasSubstr("below --min-confidence"));
  const std::string one_more =
      "please put the small yesterday blue book on the table by the window";
  const auto word = speak({"--transcript", one_more, "--min-confidence", "0.05"});
  EXPECT_EQ(word.exit_code, 3);
  EXPECT_THAT(word.err, HasSubstr("words below --min-confidence: yesterday"));
  EXPECT_FALSE(std::filesystem::exists(dir / "talk.fba"));
  EXPECT_EQ(speak({"--min-confidence", "0.05"}).exit_code, 0);
}

TEST(AlignCommand, WithoutItsTextByEarAndBesideTheRecording) {
  const TempDir dir;
  if (const auto why = no_aligner(dir); !why.empty()) GTEST_SKIP() << why;
  const auto heard = animeme({"align", dir / "voice.mp4", "--json"});
  ASSERT_EQ(heard.exit_code, 0) << heard.err;
  EXPECT_THAT(heard.err, HasSubstr("recognised without its text"));
  EXPECT_THAT(test::slurp(dir / "voice.TextGrid"), HasSubstr("IntervalTier"));
  const json found = json::parse(heard.out);
  EXPECT_TRUE(found["heard"].get<bool>());
  EXPECT_GT(found["phones"].get<int>(), 20);
  ASSERT_EQ(found["timed_phones"].size(), found["phones"].get<std::size_t>());
  // What may have been corrected by hand is not written over unasked.
  test::spill(dir / "voice.TextGrid", "mine");
  const auto again = animeme({"align", dir / "voice.mp4", "--transcript", kText});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("exists already"));
  EXPECT_EQ(test::slurp(dir / "voice.TextGrid"), "mine");
  const auto asked =
      animeme({"align", dir / "voice.mp4", "--transcript", kText, "-o", dir / "voice.TextGrid"});
  EXPECT_EQ(asked.exit_code, 0) << asked.err;
  EXPECT_FALSE(json::parse(align(dir, kText).out)["heard"].get<bool>());
}

}  // namespace align_command_test
}  // namespace animeme
