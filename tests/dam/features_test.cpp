#include "dam/script/features.h"

#include <gtest/gtest.h>

#include <string>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace features_test {

Features of(std::string_view label) { return phone_features(label)[0]; }

TEST(Features, AllPhonesButSilenceHaveThem) {
  for (const PhoneInfo& phone : phones()) {
    const auto sounds = phone_features(phone.label);
    if (phone.label == "SIL") {
      EXPECT_TRUE(sounds.empty());
      continue;
    }
    ASSERT_FALSE(sounds.empty()) << phone.label;
    EXPECT_EQ(sounds[0].manner == Manner::vowel, phone.vowel) << phone.label;
    EXPECT_EQ(sounds[0].closure == 1, phone.bilabial) << phone.label;
    EXPECT_EQ(sounds[0].place == Place::labiodental, phone.labiodental) << phone.label;
    const bool rounded = sounds[0].rounding >= 0.25 || sounds.back().rounding >= 0.25;
    EXPECT_EQ(rounded, phone.rounded) << phone.label;
  }
  EXPECT_TRUE(phone_features("QQ").empty());
}

// The nearest phone of a phone is itself.
TEST(Features, PhonesAreNearestToThemselves) {
  for (const PhoneInfo& phone : phones()) {
    const auto sounds = phone_features(phone.label);
    if (sounds.size() == 1) {
      EXPECT_EQ(nearest_phone(sounds[0]), phone.label);
      EXPECT_EQ(lip_distance(sounds[0], sounds[0]), 0);
    }
  }
}

TEST(Features, LipsWeighMost) {
  EXPECT_LT(lip_distance(of("P"), of("B")), lip_distance(of("P"), of("F")));
  EXPECT_LT(lip_distance(of("P"), of("F")), lip_distance(of("P"), of("T")));
  EXPECT_LT(lip_distance(of("UW"), of("UH")), lip_distance(of("UW"), of("IY")));
  EXPECT_LT(lip_distance(of("Y"), of("IY")), lip_distance(of("Y"), of("UW")));
  EXPECT_LT(lip_distance(of("SH"), of("ZH")), lip_distance(of("SH"), of("S")));
  for (const PhoneInfo& a : phones()) {
    for (const PhoneInfo& b : phones()) {
      if (a.label == "SIL" || b.label == "SIL") continue;
      EXPECT_EQ(lip_distance(of(a.label), of(b.label)), lip_distance(of(b.label), of(a.label)));
    }
  }
}

TEST(Features, AreSaidInTheWordsOfPhonetics) {
  EXPECT_EQ(describe(of("P")), "voiceless bilabial stop");
  EXPECT_EQ(describe(of("NG")), "voiced velar nasal");
  EXPECT_EQ(describe(of("W")), "voiced rounded velar approximant");
  EXPECT_EQ(describe(of("IY")), "close front vowel");
  EXPECT_EQ(describe(of("AO")), "open-mid back rounded vowel");
}

}  // namespace features_test
}  // namespace animeme::dam
