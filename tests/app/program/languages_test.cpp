// Text of other scripts than the voice reads: spoken by the right voice, or refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/app/program/commands.h"

namespace animeme {
namespace languages_test {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;
using testing::Not;

std::string script_of(const std::string& language, const std::string& text) {
  const TempDir dir;
  const auto made = animeme({"speak", "--lang", language, "--text", text, "-o", dir / "a.fap",
                             "--save-script", dir / "a.tsv"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return made.exit_code == 0 ? test::slurp(dir / "a.tsv") : "";
}

TEST(Languages, AnotherScriptIsRefusedWithTheVoiceToTake) {
  const TempDir dir;
  const auto chinese = animeme({"speak", "--text", "Hi 你好", "-o", dir / "a.fap"});
  EXPECT_EQ(chinese.exit_code, 3);
  EXPECT_THAT(chinese.err, HasSubstr("--lang zh"));
  const auto russian = animeme({"speak", "--text", "Hello привет", "-o", dir / "a.fap"});
  EXPECT_EQ(russian.exit_code, 3);
  EXPECT_THAT(russian.err, HasSubstr("Cyrillic"));
  EXPECT_FALSE(std::filesystem::exists(dir / "a.fap"));
}

TEST(Languages, EachScriptHasItsVoice) {
  const std::string mixed = script_of("en+ru", "Hello привет");
  EXPECT_THAT(mixed, HasSubstr("Hello"));
  EXPECT_THAT(mixed, HasSubstr("привет"));
  EXPECT_THAT(script_of("auto", "Доброе утро"), HasSubstr("утро"));
}

TEST(Languages, ChineseIsSpokenByItsCharacters) {
  const std::string script = script_of("zh", "你好");
  EXPECT_THAT(script, HasSubstr("AW\t你好"));   // ni hao
  EXPECT_THAT(script, Not(HasSubstr("TH\t")));  // "three", as an English voice names it
}

TEST(Languages, PunctuationAndDatesAreNotSpelled) {
  const std::string plain = script_of("en", "Wait"), loud = script_of("en", "Wait!!!");
  const auto phones = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(phones(plain), phones(loud));
  const std::string date = script_of("en", "12/05/2024");
  EXPECT_THAT(date, HasSubstr("TH\t12/05/2024"));       // December fifth
  EXPECT_THAT(date, Not(HasSubstr("SH\t12/05/2024")));  // slash
}

TEST(Languages, SsmlIsNotReadAloud) {
  const std::string script = script_of(
      "en", "<speak>One <break time=\"300ms\"/> two <sub alias=\"three\">3</sub></speak>");
  EXPECT_THAT(script, HasSubstr("One"));
  EXPECT_THAT(script, HasSubstr("IY\t3"));  // three, as <sub> says
  EXPECT_THAT(script, Not(HasSubstr("break")));
  const TempDir dir;
  const auto broken = animeme({"speak", "--text", "<speak>One <break", "-o", dir / "a.fap"});
  EXPECT_EQ(broken.exit_code, 3);
}

}  // namespace languages_test
}  // namespace animeme
