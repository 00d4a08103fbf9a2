#include "dam/script/phones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/shared.h"

namespace animeme::dam {
namespace phones_test {

TEST(Phones, LabelsAreUniqueAndFound) {
  std::set<std::string_view> labels;
  for (const PhoneInfo& phone : phones()) {
    EXPECT_TRUE(labels.insert(phone.label).second) << phone.label;
    EXPECT_EQ(find_phone(phone.label), &phone);
    EXPECT_LE(phone.viseme_start, 14);
    EXPECT_LE(phone.viseme_end, 14);
    EXPECT_FALSE(phone_class_name(phone.phone_class).empty());
  }
  EXPECT_EQ(labels.size(), kPhoneCount);
  EXPECT_EQ(phones()[0].label, "SIL");
  EXPECT_EQ(find_phone("aa"), nullptr);
  EXPECT_EQ(find_phone(""), nullptr);
}

TEST(Phones, ClassesAreThoseOfTheSpecification) {
  const std::map<std::string, PhoneClass> expected = {
      {"SIL", PhoneClass::silence},      {"M", PhoneClass::bilabial},
      {"V", PhoneClass::labiodental},    {"TH", PhoneClass::dental},
      {"Z", PhoneClass::alveolar},       {"Y", PhoneClass::velar},
      {"HH", PhoneClass::velar},         {"JH", PhoneClass::postalveolar},
      {"ER", PhoneClass::rounded_glide}, {"AO", PhoneClass::open_vowel},
      {"EY", PhoneClass::mid_vowel},     {"IY", PhoneClass::close_front},
      {"OY", PhoneClass::rounded_vowel}};
  for (const auto& [label, phone_class] : expected) {
    EXPECT_EQ(find_phone(label)->phone_class, phone_class) << label;
  }
}

TEST(Phones, FlagsFollowTheVisemes) {
  for (const PhoneInfo& phone : phones()) {
    EXPECT_EQ(phone.bilabial, phone.viseme_start == 1) << phone.label;
    EXPECT_EQ(phone.labiodental, phone.viseme_start == 2) << phone.label;
    if (phone.viseme_start == 14 || phone.viseme_end == 14 || phone.viseme_start == 6) {
      EXPECT_TRUE(phone.rounded) << phone.label;
    }
    EXPECT_EQ(phone.bilabial, phone.phone_class == PhoneClass::bilabial) << phone.label;
  }
}

TEST(Phones, VisemesAgreeWithTheReferenceTable) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  std::ifstream file(shared / "spec" / "phonemes" / "arpabet_master.csv");
  ASSERT_TRUE(file);
  std::string line;
  std::getline(file, line);
  std::size_t rows = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    ASSERT_GT(fields.size(), 6u);
    const PhoneInfo* phone = find_phone(fields[0]);
    ASSERT_NE(phone, nullptr) << fields[0];
    const std::string visemes = fields[6];
    const std::size_t plus = visemes.find('+');
    EXPECT_EQ(phone->viseme_start, std::stoi(visemes)) << fields[0];
    EXPECT_EQ(phone->viseme_end,
              plus == std::string::npos ? std::stoi(visemes) : std::stoi(visemes.substr(plus + 1)))
        << fields[0];
    EXPECT_EQ(phone->ipa, fields[1]);
    ++rows;
  }
  EXPECT_EQ(rows, kPhoneCount);
}

TEST(Phones, SpellingsOfAligners) {
  EXPECT_EQ(arpabet_label("AA1"), "AA");
  EXPECT_EQ(arpabet_label("ah0"), "AH");
  EXPECT_EQ(arpabet_label("hh"), "HH");
  EXPECT_EQ(arpabet_label("axr"), "ER");
  EXPECT_EQ(arpabet_label("dx"), "D");
  EXPECT_EQ(arpabet_label("B1"), "");  // consonants have no stress
  EXPECT_EQ(arpabet_label("AA5"), "");
  EXPECT_EQ(arpabet_label("QQ"), "");
  for (const char* silence :
       {"", "sil", "SIL", "sp", "spn", "pau", "h#", "_", "<sil>", "<eps>", "silence"}) {
    EXPECT_EQ(arpabet_label(silence), "SIL") << silence;
    EXPECT_TRUE(is_silence_spelling(silence)) << silence;
  }
  EXPECT_FALSE(is_silence_spelling("S"));
}

TEST(Phones, NearestLabelLooksAlike) {
  EXPECT_EQ(nearest_label("AAA"), "AA");
  EXPECT_EQ(nearest_label("shh"), "SH");
  EXPECT_EQ(nearest_label("ng1"), "NG");
  EXPECT_FALSE(nearest_label("").empty());
  EXPECT_FALSE(nearest_label(std::string(1000, 'x')).empty());
}

TEST(PhoneRelatives, EveryLabelHasWellFormedOnes) {
  for (const PhoneInfo& phone : phones()) {
    const auto relatives = phone_relatives(phone.label);
    if (phone.label == "SIL") {
      EXPECT_TRUE(relatives.empty());  // every model knows it
      continue;
    }
    ASSERT_GE(relatives.size(), kPhoneCount - 2) << phone.label;  // all others
    for (const Relative& relative : relatives) {
      double total = 0;
      for (const RelativePart& part : relative.parts()) {
        EXPECT_NE(part.label, phone.label) << phone.label;
        EXPECT_TRUE(part.label == kNextVowel || part.label == kVowelBefore ||
                    find_phone(part.label) != nullptr)
            << phone.label << " -> " << part.label;
        EXPECT_GT(part.share, 0);
        total += part.share;
      }
      EXPECT_DOUBLE_EQ(total, 1.0) << phone.label;
    }
  }
  EXPECT_TRUE(phone_relatives("QQ").empty());
}

TEST(PhoneRelatives, LipContactsSurviveWhileTheModelHasAny) {
  for (const PhoneInfo& phone : phones()) {
    if (!phone.bilabial && !phone.labiodental) continue;
    const Relative& first = phone_relatives(phone.label)[0];
    ASSERT_EQ(first.count, 1u);
    EXPECT_EQ(find_phone(first.part[0].label)->phone_class, phone.phone_class) << phone.label;
  }
}

TEST(PhoneRelatives, DiphthongsStartAndEndWithTheirVisemes) {
  for (const char* label : {"AW", "AY", "EY", "OW", "OY"}) {
    const PhoneInfo* phone = find_phone(label);
    const Relative& first = phone_relatives(label)[0];
    ASSERT_EQ(first.count, 2u) << label;
    EXPECT_EQ(find_phone(first.part[0].label)->viseme_start, phone->viseme_start) << label;
    EXPECT_EQ(find_phone(first.part[1].label)->viseme_end, phone->viseme_end) << label;
  }
}

// A corpus of number words and letters, as small ones are, still covers everything.
TEST(PhoneRelatives, AGridLikeModelKnowsAnAlternativeForEveryPhone) {
  std::set<std::string_view> known;
  for (const PhoneInfo& phone : phones()) known.insert(phone.label);
  for (const char* missing : {"AX", "ER", "HH", "NG", "OY", "SH", "UH", "ZH"}) known.erase(missing);
  const auto usable = [&](const Relative& relative) {
    for (const RelativePart& part : relative.parts()) {
      const bool beside = part.label == kNextVowel || part.label == kVowelBefore;
      if (!beside && !known.contains(part.label)) return false;
    }
    return true;
  };
  const std::map<std::string, std::string> expected = {
      {"AX", "AH"}, {"ER", "AH"}, {"NG", std::string(kVowelBefore)}, {"OY", "AO"}, {"SH", "CH"},
      {"UH", "UW"}, {"ZH", "JH"}, {"HH", std::string(kNextVowel)}};
  for (const auto& [label, first_part] : expected) {
    const auto relatives = phone_relatives(label);
    const auto found = std::find_if(relatives.begin(), relatives.end(), usable);
    ASSERT_NE(found, relatives.end()) << label;
    EXPECT_EQ(found->part[0].label, first_part) << label;
  }
}

}  // namespace phones_test
}  // namespace animeme::dam
