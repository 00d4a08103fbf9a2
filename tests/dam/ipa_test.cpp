#include "dam/script/ipa.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "dam/script/phones.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace ipa_test {

std::string labels(std::string_view ipa) {
  const auto parsed = parse_ipa(ipa);
  if (!parsed) return "error: " + parsed.error().message;
  std::string out;
  double total = 0;
  for (const IpaPhone& phone : *parsed) {
    if (!out.empty()) out += ' ';
    out += phone.label;
    total += phone.share;
    EXPECT_NE(find_phone(phone.label), nullptr);
    EXPECT_GT(phone.share, 0);
  }
  if (!parsed->empty()) {
    EXPECT_NEAR(total, 1.0, 1e-12) << ipa;
  }
  return out;
}

// The fields of a line of CSV; doubled quotes inside quoted fields.
std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

TEST(Ipa, AffricatesAndDiphthongsStayOnePhone) {
  EXPECT_EQ(labels("tʃ"), "CH");
  EXPECT_EQ(labels("t͡ʃ"), "CH");
  EXPECT_EQ(labels("ʧ"), "CH");
  EXPECT_EQ(labels("tʃʰ"), "CH");
  EXPECT_EQ(labels("dʒ"), "JH");
  EXPECT_EQ(labels("tɕ"), "CH");
  EXPECT_EQ(labels("aɪ"), "AY");
  EXPECT_EQ(labels("aʊ"), "AW");
  EXPECT_EQ(labels("aːɪ"), "AY");
  EXPECT_EQ(labels("ɐ̃ʊ̃"), "AW");
  EXPECT_EQ(labels("ai̯"), "AY");
  EXPECT_EQ(labels("əʊ"), "OW");
  EXPECT_EQ(labels("ɔɪ"), "OY");
  EXPECT_EQ(labels("ts"), "T S");
  EXPECT_EQ(labels("ʦ"), "T S");
  EXPECT_EQ(labels("iə"), "IY AX");
}

TEST(Ipa, TheLipsDecide) {
  EXPECT_EQ(labels("y"), "UW");
  EXPECT_EQ(labels("yː"), "UW");
  EXPECT_EQ(labels("ø"), "UH");
  EXPECT_EQ(labels("œ"), "AO");
  EXPECT_EQ(labels("ʁ"), "G");
  EXPECT_EQ(labels("ʀ"), "G");
  EXPECT_EQ(labels("ɸ"), "P");
  EXPECT_EQ(labels("β"), "B");
  EXPECT_EQ(labels("ɱ"), "V");
  EXPECT_EQ(labels("ɥ"), "W");
  EXPECT_EQ(labels("ʔ"), "HH");
  EXPECT_EQ(labels("ħ"), "HH");
  EXPECT_EQ(labels("ç"), "Y");
  EXPECT_EQ(labels("c\u0327"), "Y");  // the same letter, decomposed
  EXPECT_EQ(labels("ɯ"), "IH");
}

TEST(Ipa, MarksThatMatterAndMarksThatDoNot) {
  EXPECT_EQ(labels("ɜː"), "ER");
  EXPECT_EQ(labels("ɜ"), "AX");
  EXPECT_EQ(labels("r̝"), "ZH");
  EXPECT_EQ(labels("kʷ"), "K W");
  EXPECT_EQ(labels("tʲ"), "T");
  EXPECT_EQ(labels("pʰ"), "P");
  EXPECT_EQ(labels("ph"), "P");
  EXPECT_EQ(labels("h"), "HH");
  EXPECT_EQ(labels("ˈɛ̃"), "EH");
  EXPECT_EQ(labels("ã"), "AA");  // composed
  EXPECT_EQ(labels("ã"), "AA");  // decomposed
  EXPECT_EQ(labels("i̯"), "Y");
  EXPECT_EQ(labels("u̯"), "W");
  EXPECT_EQ(labels("a5"), "AA");
  EXPECT_EQ(labels("˥"), "");
  EXPECT_EQ(labels(""), "");
}

TEST(Ipa, MarksChangeFeatures) {
  EXPECT_EQ(labels("r̝̊"), "SH");
  EXPECT_EQ(labels("a˞"), "AA R");
  EXPECT_EQ(labels("ə˞"), "ER");
  EXPECT_EQ(labels("b̥"), "P");
  EXPECT_EQ(labels("ɔ̜̜̜"), "AH");  // rounding taken away
  EXPECT_EQ(labels("ᵐb"), "M B");
  EXPECT_EQ(labels("dⁿ"), "D");
  EXPECT_EQ(labels("t_w"), "T W");  // X-SAMPA
  EXPECT_EQ(labels("u_^"), "W");
  EXPECT_EQ(labels("tsh"), "T S");
}

TEST(Ipa, DiphthongsAreToldByWhereTheyBeginAndEnd) {
  EXPECT_EQ(labels("aɨ"), "AY");
  EXPECT_EQ(labels("ʌɪ") + " " + labels("ʌʊ"), "AY AW") << "as some dictionaries write them";
  EXPECT_EQ(labels("æʊ"), "AW");
  EXPECT_EQ(labels("ɔø"), "AO UH");  // ends rounded: not OY
  EXPECT_EQ(labels("ie"), "IY EY");
  EXPECT_EQ(labels("aɪʊ"), "AY UH");
  EXPECT_EQ(labels("yɪ"), "UW IH");
}

TEST(Ipa, WhatIsExactAndWhatIsNearest) {
  const auto sounds = [](std::string_view ipa) { return parse_ipa_sounds(ipa).value(); };
  for (const char* exact : {"p", "ʃ", "tʃ", "aɪ", "uː", "ɝ", "g", "ɡ"}) {
    EXPECT_TRUE(sounds(exact)[0].exact) << exact;
  }
  for (const char* other : {"y", "r", "tɕ", "aj", "e", "b̥"}) {
    EXPECT_FALSE(sounds(other)[0].exact) << other;
  }
  EXPECT_EQ(describe(sounds("y")[0].heard[0]), "close front rounded vowel");
  EXPECT_EQ(describe(sounds("ɣ")[0].heard[0]), "voiced velar fricative");
  EXPECT_EQ(sounds("tɕ")[0].heard.size(), 2u);
}

TEST(Ipa, XSampaIsASecondAlphabet) {
  EXPECT_EQ(labels("S"), "SH");
  EXPECT_EQ(labels("tS"), "CH");
  EXPECT_EQ(labels("@"), "AX");
  EXPECT_EQ(labels("3:"), "ER");
  EXPECT_EQ(labels("2:"), "UH");
  EXPECT_EQ(labels("\"2:"), "UH");
  EXPECT_EQ(labels("9"), "AO");
  EXPECT_EQ(labels("{"), "AE");
  EXPECT_EQ(labels("r\\"), "R");
  EXPECT_EQ(labels("t_h"), "T");
  EXPECT_EQ(labels("aI"), "AY");
  EXPECT_EQ(labels("N"), "NG");
  EXPECT_EQ(labels("R"), "G");
}

TEST(Ipa, UnknownLettersAreNamed) {
  const auto parsed = parse_ipa("ж");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Code::not_found);
  EXPECT_NE(parsed.error().message.find("U+0436"), std::string::npos) << parsed.error().message;
  EXPECT_NE(parsed.error().message.find("ж"), std::string::npos);
  EXPECT_EQ(parse_ipa(std::string(65, 'a')).error().code, Code::out_of_range);
}

TEST(Ipa, EveryByteStringIsAnswered) {
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      const char text[] = {char(a), char(b), 'a'};
      const auto parsed = parse_ipa({text, 3});
      if (parsed) {
        EXPECT_LE(parsed->size(), 4u);
      } else {
        EXPECT_EQ(parsed.error().code, Code::not_found);
      }
    }
  }
}

// The viseme of the phone is that of the letter, for all letters of the chart.
TEST(Ipa, AllLettersKeepTheirViseme) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  std::ifstream file(shared / "spec" / "phonemes" / "ipa_to_mpeg4.csv");
  ASSERT_TRUE(file);
  // Bilabial fricatives close like the stops of their place; an affricate starts as its stop; a
  // tap is a short stop wherever the tip of the tongue is.
  const std::map<std::string, int> exceptions = {{"ɸ", 1}, {"Φ", 1}, {"ʦ", 4}, {"ʣ", 4}, {"ɽ", 4}};
  std::string line;
  std::getline(file, line);
  int rows = 0;
  while (std::getline(file, line)) {
    const auto fields = csv_fields(line);
    ASSERT_GE(fields.size(), 7u) << line;
    const auto parsed = parse_ipa(fields[0]);
    ASSERT_TRUE(parsed) << parsed.error().describe();
    ASSERT_FALSE(parsed->empty()) << fields[0];
    const PhoneInfo* phone = find_phone((*parsed)[0].label);
    const auto exception = exceptions.find(fields[0]);
    const int expected = exception == exceptions.end() ? std::stoi(fields[6]) : exception->second;
    EXPECT_EQ(phone->viseme_start, expected) << fields[0] << " -> " << phone->label;
    ++rows;
  }
  EXPECT_GE(rows, 116);
}

TEST(Ipa, ModifiersAloneAreNoSound) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  std::ifstream file(shared / "spec" / "phonemes" / "ipa_modifiers.csv");
  ASSERT_TRUE(file);
  std::string line;
  std::getline(file, line);
  int rows = 0;
  while (std::getline(file, line)) {
    const std::string symbol = csv_fields(line)[0];
    EXPECT_EQ(labels(symbol), "") << symbol;
    EXPECT_EQ(labels("m" + symbol).substr(0, 1), "M") << symbol;
    ++rows;
  }
  EXPECT_GT(rows, 40);
}

TEST(Ipa, EverythingThatEspeakSaysIsKnown) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  std::ifstream file(shared / "spec" / "phonemes" / "espeak_mnemonic_ipa_by_voice.csv");
  ASSERT_TRUE(file);
  // Marks without a sound of their own: they lengthen the phone before them.
  const std::set<std::string> marks = {"", "ː", "ʲ", "\u0303"};
  std::string line;
  std::getline(file, line);
  int rows = 0;
  while (std::getline(file, line)) {
    const std::string ipa = csv_fields(line)[2];
    const auto parsed = parse_ipa(ipa);
    ASSERT_TRUE(parsed) << line << ": " << parsed.error().describe();
    EXPECT_EQ(parsed->empty(), marks.contains(ipa)) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 3155);
}

}  // namespace ipa_test
}  // namespace animeme::dam
