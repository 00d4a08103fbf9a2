#include "tools/speech/text/passages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/speech/text/guess.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/utterance.h"

namespace animeme::text {
namespace passages_test {

using testing::HasSubstr;

Speakers speakers(const std::vector<std::string>& languages, bool automatic = false) {
  Speakers all;
  all.automatic = automatic;
  for (const std::string& language : languages) {
    all.list.push_back(make_speaker(language, "x/" + language, language));
  }
  all.find = [](const std::string& language) -> std::optional<Speaker> {
    if (language == "km") return std::nullopt;
    return make_speaker(language == "zh" ? "cmn" : language, "x/" + language, language);
  };
  return all;
}

// "en:hello |cmn:你好"
std::string parted(const std::string& text, const std::vector<std::string>& languages,
                   bool automatic = false) {
  Speakers all = speakers(languages, automatic);
  const auto passages = part_passages(as_written(code_points(text)), all);
  if (!passages) return passages.error().message;
  std::string out;
  for (const Passage& passage : *passages) {
    out += (out.empty() ? "" : "|") + all.list[passage.speaker].language + ":" +
           utf8(passage.said.text);
  }
  return out;
}

#define SKIP_WITHOUT_ICU() \
  if (!unicode_here()) GTEST_SKIP() << "built without ICU"

TEST(Passages, ByScript) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(parted("我喜欢 Python。", {"cmn"}), "cmn:我喜欢 |en:Python。");
  EXPECT_EQ(parted("Hello Привет мир!", {"en", "ru"}), "en:Hello |ru:Привет мир!");
  EXPECT_EQ(parted("Здраво, dobar", {"sr", "hr"}), "sr:Здраво, dobar");
  EXPECT_EQ(parted("Привет, Python", {"ru"}), "ru:Привет, Python") << "by itself";
  EXPECT_EQ(parted("Привет, Python", {"ru", "de"}), "ru:Привет, |de:Python");
}

TEST(Passages, DigitsGoWithTheirNeighbours) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(parted("iPhone 15 很好", {"cmn"}), "en:iPhone|cmn: 15 很好");
  EXPECT_EQ(parted("MP3 很好", {"cmn"}), "en:MP3 |cmn:很好");
  EXPECT_EQ(parted("I have 我有3个 here", {"en", "cmn"}), "en:I have |cmn:我有3个 |en:here");
  EXPECT_EQ(parted("重5 kg。", {"cmn"}), "cmn:重5 kg。");
  EXPECT_EQ(parted("25°C和60km/h", {"cmn"}), "cmn:25°C和60km/h");
}

TEST(Passages, RefusalsNameTheVoiceToTake) {
  SKIP_WITHOUT_ICU();
  EXPECT_THAT(parted("say 你好", {"en"}),
              testing::AllOf(HasSubstr("\"你好\" has Chinese characters"), HasSubstr("--lang zh"),
                             HasSubstr("--lang en+zh")));
  EXPECT_THAT(parted("日本の", {"en"}), HasSubstr("--lang ja"));
  EXPECT_THAT(parted("їжа", {"en"}), HasSubstr("--lang uk"));
  EXPECT_THAT(parted("ភាសា", {"en"}), HasSubstr("has no voice"));
}

TEST(Passages, AutomaticByAlphabet) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(parted("hi привіт їжа", {"en"}, true), "en:hi |uk:привіт їжа");
  EXPECT_EQ(parted("hi привет", {"en"}, true), "en:hi |ru:привет");
  EXPECT_EQ(parted("سلام", {"en"}, true), "ar:سلام");
  EXPECT_EQ(parted("پگاه", {"en"}, true), "fa:پگاه");
  EXPECT_EQ(first_language(U"123 こんにちは"), "ja");
  EXPECT_EQ(first_language(U"hello"), "");
}

TEST(Passages, SentencesOfOneAlphabetByTheirWords) {
  if (!unicode_here() || !can_guess()) GTEST_SKIP() << "built without ICU or CLD2";
  const std::string two = "We wait for the train. Wir warten auf den Zug.";
  EXPECT_EQ(parted(two, {"en"}, true), "en:We wait for the train. |de:Wir warten auf den Zug.");
  EXPECT_EQ(parted(two, {"de", "en"}), "en:We wait for the train. |de:Wir warten auf den Zug.");
  EXPECT_EQ(parted(two, {"en"}), "en:" + two) << "nobody else may speak";
  EXPECT_EQ(parted(two, {"en", "fr"}), "en:" + two) << "nobody else speaks German";
  EXPECT_EQ(first_language(U"Wir warten auf den Zug."), "de");
  // A document that names the language is believed.
  const auto made = make_utterance(
      "<speak><lang xml:lang=\"en\">Wir warten auf den Zug.</lang> Wir warten auf den Zug.</speak>",
      speakers({"fr"}, true),
      {[](const std::string& language, const std::string&) -> std::optional<Speaker> {
         return make_speaker(language, "x/" + language, language);
       },
       {}});
  ASSERT_TRUE(made) << made.error().describe();
  std::string who;
  for (const Stretch& part : made->stretches) who += made->speakers[part.speaker].language + " ";
  EXPECT_EQ(who, "en de ");
}

TEST(Passages, AGreekLetterIsSpokenByItsName) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(parted("about π", {"en"}), "en:about π");
  EXPECT_THAT(parted("καλημέρα", {"en"}), HasSubstr("--lang el"));
}

TEST(Utterance, PlainTextOfOneVoiceStaysAsItIs) {
  const auto made = make_utterance("Hello, \"big\" world (yes). It's 5!", speakers({"en"}), {});
  ASSERT_TRUE(made);
  EXPECT_EQ(utf8(made->input.text), "Hello, \"big\" world (yes). It's 5!");
  EXPECT_FALSE(made->markup);
}

TEST(Utterance, MarkupIsEscapedAndKnowsItsPlaces) {
  SKIP_WITHOUT_ICU();
  const auto made = make_utterance("мир & 2 < 3 hi", speakers({"en", "ru"}), {});
  ASSERT_TRUE(made) << made.error().describe();
  EXPECT_EQ(utf8(made->input.text),
            "<voice name=\"x/ru\">мир</voice><voice name=\"x/en\"> &amp; 2 &lt; 3 hi</voice>");
  EXPECT_EQ(made->input.places[19], (Place{0, 1}));
  ASSERT_EQ(made->stretches.size(), 2u);
}

TEST(Unicode, LanguagesHaveThreeLetters) {
  SKIP_WITHOUT_ICU();
  for (const auto& [language, code] : {std::pair{"de-at", "deu"},
                                       {"en-gb-x-rp", "eng"},
                                       {"cmn-latn-pinyin", "zho"},
                                       {"zh+en", "zho"},
                                       {"yue", "yue"},
                                       {"nb", "nor"},
                                       {"", "und"},
                                       {"English (Scotland)", "und"},
                                       {"auto", "und"}}) {
    EXPECT_EQ(language_code(language), code) << language;
  }
}

}  // namespace passages_test
}  // namespace animeme::text
