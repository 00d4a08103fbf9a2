#include "tools/speech/text/ssml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/ssml_values.h"

namespace animeme::text {
namespace ssml_test {

using testing::HasSubstr;

Document read(const std::string& text) {
  auto document = read_ssml(text);
  if (!document && document.error().code == Code::unsupported) return {};
  EXPECT_TRUE(document) << document.error().describe();
  return document ? *std::move(document) : Document{};
}

#define SKIP_WITHOUT_EXPAT()                               \
  if (const auto probe = read_ssml("<speak/>");            \
      !probe && probe.error().code == Code::unsupported) { \
    GTEST_SKIP() << probe.error().message;                 \
  }

TEST(Ssml, IsToldByContent) {
  EXPECT_TRUE(is_ssml("<speak>hi</speak>"));
  EXPECT_TRUE(
      is_ssml("\xEF\xBB\xBF <?xml version=\"1.0\"?>\n<!-- a > b --><speak version='1.1'/>"));
  EXPECT_TRUE(is_ssml("<!DOCTYPE speak [<!ENTITY a 'b'>]><speak>&a;</speak>"));
  EXPECT_FALSE(is_ssml("<speaker>"));
  EXPECT_FALSE(is_ssml("say <speak>"));
  EXPECT_FALSE(is_ssml(""));
}

TEST(Ssml, MoodsAreStyles) {
  SKIP_WITHOUT_EXPAT();
  const Document d = read(
      "<speak xmlns:mstts='x'>a<mstts:express-as style='cheerful'>b<emphasis level='strong'>c"
      "</emphasis><mstts:express-as style='terrified' styledegree='0.5'>d</mstts:express-as>"
      "</mstts:express-as><amazon:emotion name='excited' intensity='low'>e</amazon:emotion>"
      "<google:style name='apologetic'>f</google:style><emphasis level='reduced'>g</emphasis>"
      "</speak>");
  std::vector<std::string> all;
  for (const Item& item : d.items) {
    all.push_back(utf8(item.text) + " " + (item.mood ? dam::mood_text(*item.mood) : "none"));
    if (item.mood_gain > 1) all.back() += " more";
    if (item.mood_gain < 1) all.back() += " less";
  }
  EXPECT_THAT(all, testing::ElementsAre("a none", "b joy:0.8", "c joy:0.8 more", "d fear:0.5",
                                        "e excited:0.6", "f sadness:0.5", "g none less"));
  EXPECT_THAT(d.warnings, testing::IsEmpty());
  const Document odd = read(
      "<speak><mstts:express-as style='zzz'>a</mstts:express-as>"
      "<mstts:express-as style='sad' styledegree='big'>b</mstts:express-as></speak>");
  EXPECT_THAT(odd.warnings, testing::ElementsAre(HasSubstr("style=\"zzz\"> is no mood"),
                                                 HasSubstr("styledegree=\"big\"> is not known")));
  EXPECT_FALSE(odd.items[0].mood);
  EXPECT_EQ(odd.items[1].mood->name, "sadness");
}

TEST(Ssml, ItemsInOrder) {
  SKIP_WITHOUT_EXPAT();
  const Document d = read(
      "<speak>a<break time='300ms'/><mark name='m'/><sub alias='b c'>b&amp;</sub>"
      "<prosody rate='150%' volume='+6dB'>d<emphasis>e</emphasis></prosody>"
      "<say-as interpret-as='telephone'>12</say-as><phoneme alphabet='ipa' ph='x'>y</phoneme>"
      "</speak>");
  ASSERT_EQ(d.items.size(), 8u);
  EXPECT_EQ(d.items[0].text, U"a");
  EXPECT_EQ(d.items[1].kind, ItemKind::pause);
  EXPECT_DOUBLE_EQ(d.items[1].seconds, 0.3);
  EXPECT_EQ(d.items[2].name, "m");
  EXPECT_EQ(d.items[3].text, U"b&") << "entities are one text";
  EXPECT_EQ(d.items[3].alias, U"b c");
  EXPECT_EQ(d.items[4].manner.rate, 150);
  EXPECT_EQ(d.items[4].manner.volume, 200);
  EXPECT_LT(d.items[5].manner.rate, 150);
  EXPECT_EQ(d.items[6].say_as, SayAs::telephone);
  EXPECT_EQ(d.items[7].ipa, "x");
  EXPECT_EQ(d.items[7].manner, Manner{});
  EXPECT_TRUE(d.warnings.empty());
}

TEST(Ssml, PhonemesOfTwoAlphabets) {
  SKIP_WITHOUT_EXPAT();
  const Document d = read(
      "<speak><phoneme alphabet='x-sampa' ph='pI&quot;kA:n'>a</phoneme> "
      "<phoneme alphabet='X-SAMPA' ph='t_SEn@_r'>b</phoneme> "
      "<phoneme alphabet='IPA' ph='ə'>c</phoneme> <phoneme ph='ɪ'>d</phoneme></speak>");
  std::vector<std::string> ipa;
  for (const Item& item : d.items) {
    if (!item.ipa.empty()) ipa.push_back(item.ipa);
  }
  EXPECT_EQ(ipa, (std::vector<std::string>{"pɪˈkɑːn", "tʃɛnə\u031D", "ə", "ɪ"}));
  EXPECT_TRUE(d.warnings.empty());
}

TEST(Ssml, LanguagesAreInherited) {
  SKIP_WITHOUT_EXPAT();
  const Document d = read(
      "<speak xml:lang='en'>a<p xml:lang='de'>b<lang xml:lang='fr'>c</lang>d</p>e"
      "<voice gender='female'>f</voice></speak>");
  std::string languages;
  for (const Item& item : d.items) {
    if (item.kind == ItemKind::text) languages += item.manner.language + " ";
  }
  EXPECT_EQ(languages, "en de fr de en en ");
  EXPECT_EQ(d.items.back().manner.voice, "f2");
}

TEST(Ssml, WhatIsUnknownIsSpokenAndNamedOnce) {
  SKIP_WITHOUT_EXPAT();
  const Document d = read("<speak><x>a</x><x>b</x><metadata>no</metadata></speak>");
  ASSERT_EQ(d.items.size(), 2u);
  ASSERT_EQ(d.warnings.size(), 1u);
  EXPECT_THAT(d.warnings[0], HasSubstr("<x>"));
}

TEST(Ssml, ErrorsHaveAPlace) {
  SKIP_WITHOUT_EXPAT();
  const auto open = read_ssml("<speak>\n<p>a</speak>");
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, Code::syntax);
  EXPECT_EQ(open.error().where.line, 2);
  EXPECT_EQ(open.error().where.column, 7);
  EXPECT_FALSE(read_ssml("<p>a</p>"));
  std::string deep = "<speak>";
  for (int i = 0; i < 100; ++i) deep += "<p>";
  EXPECT_THAT(read_ssml(deep).error().message, HasSubstr("deep"));
}

TEST(Ssml, NoEntitiesOfItsOwn) {
  SKIP_WITHOUT_EXPAT();
  const auto laughs =
      read_ssml("<!DOCTYPE speak [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;'>]><speak>&b;</speak>");
  ASSERT_FALSE(laughs);
  EXPECT_THAT(laughs.error().message, HasSubstr("entities"));
  EXPECT_FALSE(read_ssml("<speak>&nbsp;</speak>"));
  EXPECT_TRUE(read_ssml("<!DOCTYPE speak PUBLIC '-//W3C//DTD SYNTHESIS 1.0//EN' 'x.dtd'><speak/>"));
}

TEST(SsmlValues, NumbersAndNames) {
  EXPECT_EQ(rate_of("slow", 100), 75);
  EXPECT_EQ(rate_of("1.5", 100), 150);
  EXPECT_EQ(rate_of("+20%", 200), 240);
  EXPECT_EQ(rate_of("soon", 100), std::nullopt);
  EXPECT_EQ(pitch_of("+12st", 100), 200);
  EXPECT_EQ(pitch_of("-50%", 100), 50);
  EXPECT_EQ(volume_of("silent", 100), 0);
  EXPECT_EQ(volume_of("-6dB", 100), 50);
  EXPECT_EQ(seconds_of("0.5s"), 0.5);
  EXPECT_EQ(seconds_of("1h"), std::nullopt);
  EXPECT_EQ(seconds_of("99999s"), 10);
}

}  // namespace ssml_test
}  // namespace animeme::text
