// What a voice can say, and what is said for it: `animeme phones`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/program/commands.h"

namespace animeme {
namespace phones_command_test {

using test::animeme;
using Json = nlohmann::json;
using test::TempDir;
using testing::HasSubstr;
using testing::Not;

TEST(PhonesCommand, NamesTheSoundsOfALanguage) {
  const auto made = animeme({"phones", "--lang", "ru", "--json"});
  if (made.exit_code != 0 && made.err.find("no text to speech") != std::string::npos) {
    GTEST_SKIP() << "built without espeak-ng";
  }
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json all = Json::parse(made.out);
  EXPECT_EQ(all["counts"]["unknown"], 0);
  const Json& symbols = all["symbols"];
  const auto vowel = std::find_if(symbols.begin(), symbols.end(),
                                  [](const Json& symbol) { return symbol["symbol"] == "y"; });
  ASSERT_NE(vowel, symbols.end());
  EXPECT_EQ((*vowel)["phones"], Json::array({"IH"}));
  EXPECT_EQ((*vowel)["match"], "features");
  EXPECT_EQ((*vowel)["features"], Json::array({"close central vowel"}));
  const auto text = animeme({"phones", "--lang", "ru"});
  EXPECT_THAT(text.out, HasSubstr("close central vowel"));
  EXPECT_THAT(text.err, HasSubstr("0 are unknown"));
}

TEST(PhonesCommand, AnUnknownLanguageIsAnError) {
  const auto made = animeme({"phones", "--lang", "zz"});
  EXPECT_EQ(made.exit_code, 3);
  EXPECT_THAT(made.err, HasSubstr("animeme"));
  EXPECT_EQ(animeme({"phones", "--lang", "de", "--all-languages"}).exit_code, 2);
}

// Vowels of other languages, as the built-in model says them: round ones are narrower and further
// forward than flat ones of the same height, an open one has a wider gap than u.
TEST(PhonesCommand, DrawsTheVowelsOfTheChart) {
  const TempDir dir;
  const auto sheet = dir / "vowels.svg";
  const auto made = animeme({"phones", "--sheet", sheet, "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json vowels = Json::parse(made.out)["vowels"];
  ASSERT_EQ(vowels.size(), 29u);
  const auto of = [&](const char* ipa) {
    return *std::find_if(vowels.begin(), vowels.end(),
                         [&](const Json& vowel) { return vowel["ipa"] == ipa; });
  };
  EXPECT_EQ(of("")["name"], "rest");
  EXPECT_LT(of("")["gap"].get<double>(), 25);
  for (const auto& [round, flat] :
       {std::pair{"y", "i"}, std::pair{"u", "ɯ"}, std::pair{"ø", "e"}, std::pair{"ʉ", "ɨ"}}) {
    EXPECT_LT(of(round)["width"].get<double>(), of(flat)["width"].get<double>()) << round;
    EXPECT_GT(of(round)["forward"].get<double>(), of(flat)["forward"].get<double>()) << round;
  }
  EXPECT_GT(of("ɑ")["gap"].get<double>(), 1.3 * of("u")["gap"].get<double>());
  std::ifstream file(sheet);
  const std::string svg((std::istreambuf_iterator<char>(file)), {});
  std::size_t pictures = 0;
  for (auto at = svg.find("<image"); at != std::string::npos; at = svg.find("<image", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 29u);
  for (const char* ipa : {">y  ", ">ø  ", ">ɯ  ", ">rest<"}) EXPECT_THAT(svg, HasSubstr(ipa));
}

TEST(PhonesCommand, ASheetIsAPictureAndHasNoLanguage) {
  EXPECT_EQ(animeme({"phones", "--sheet", "a.txt"}).exit_code, 2);
  EXPECT_EQ(animeme({"phones", "--sheet", "a.png", "--lang", "de"}).exit_code, 2);
  EXPECT_EQ(animeme({"phones", "--model", "a.dam"}).exit_code, 2);
  EXPECT_EQ(animeme({"phones", "--sheet", "a.png", "--model", "missing.dam"}).exit_code, 3);
}

TEST(PhonesCommand, WhatAModelLacksIsSaidWhenAsked) {
  const TempDir dir;
  const auto script = dir / "hello.tsv";
  std::ofstream(script) << "start_s\tend_s\tphone\n0\t0.3\tHH\n0.3\t0.5\tAH\n0.5\t0.8\tOY\n";
  const auto quiet = animeme({"speak", "--script", script, "-o", dir / "a.fap"});
  ASSERT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_THAT(quiet.err, Not(HasSubstr("spoken as")));
  const auto verbose = animeme({"speak", "-v", "--script", script, "-o", dir / "a.fap"});
  EXPECT_THAT(verbose.err, HasSubstr("the model has no phone HH: it is spoken as AH"));
  EXPECT_THAT(verbose.err, HasSubstr("the model has no phone OY: it is spoken as AO IH"));
}

}  // namespace phones_command_test
}  // namespace animeme
