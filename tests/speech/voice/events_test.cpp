// From events to a script, with made-up events: needs no voice.
#include <gtest/gtest.h>

#include "tools/speech/voice/transcript.h"
#include "tools/speech/voice/voice_choice.h"
#include "tools/speech/voice/voice_events.h"

namespace animeme::voice {
namespace events_test {

constexpr int kRate = 1000;  // a sample is a millisecond

VoiceEvent phoneme(std::int64_t sample, std::string ipa) {
  return {EventKind::phoneme, sample, 0, 0, std::move(ipa)};
}

VoiceEvent word(std::int64_t sample, int position, int length) {
  return {EventKind::word, sample, position, length, {}};
}

// `loud` pieces of sound in `size` samples of silence.
std::vector<bool> sound(std::size_t size, std::initializer_list<std::pair<int, int>> loud) {
  std::vector<bool> silent(size, true);
  for (const auto& [first, last] : loud) {
    for (int i = first; i < last; ++i) silent[std::size_t(i)] = false;
  }
  return silent;
}

TEST(VoiceScript, ClosureBelongsToTheStop) {
  // a: 100 to 200; closed until 250; burst of p; a again.
  const RawSpeech raw{sound(500, {{100, 200}, {250, 400}}),
                      {word(100, 1, 3), phoneme(100, "a"), phoneme(250, "p"), phoneme(280, "a"),
                       phoneme(400, "_:")}};
  const dam::Script script = make_voice_script(raw, kRate, "apa");
  const dam::Script expected{{{0, 0.1, "SIL", ""},
                              {0.1, 0.2, "AA", "apa"},
                              {0.2, 0.28, "P", "apa"},
                              {0.28, 0.4, "AA", "apa"},
                              {0.4, 0.5, "SIL", ""}}};
  EXPECT_EQ(script, expected);
}

TEST(VoiceScript, AfterAPauseTheClosureIsShort) {
  const RawSpeech raw{sound(700, {{500, 700}}), {phoneme(500, "b"), phoneme(550, "i")}};
  const dam::Script script = make_voice_script(raw, kRate, "");
  ASSERT_EQ(script.phones.size(), 3u);
  EXPECT_DOUBLE_EQ(script.phones[1].start, 0.42);
}

TEST(VoiceScript, AnEmptyNameIsAMarkWhereThereIsSoundAndAPauseWhereThereIsNone) {
  const RawSpeech raw{
      sound(500, {{0, 300}}),
      {phoneme(0, "s"), phoneme(100, ""), phoneme(200, "i"), phoneme(300, ""), phoneme(400, "")}};
  const dam::Script script = make_voice_script(raw, kRate, "");
  const dam::Script expected{{{0, 0.2, "S", ""}, {0.2, 0.3, "IY", ""}, {0.3, 0.5, "SIL", ""}}};
  EXPECT_EQ(script, expected);
}

TEST(VoiceScript, SwitchesCutNamesAndUnknownLetters) {
  const RawSpeech raw{sound(500, {{0, 500}}),
                      {phoneme(0, "m"), phoneme(100, "(en)"), phoneme(200, "aɪ\xCA"),
                       phoneme(300, "ж"), phoneme(400, "ts")}};
  const dam::Script script = make_voice_script(raw, kRate, "");
  const dam::Script expected{{{0, 0.2, "M", ""},
                              {0.2, 0.3, "AY", ""},
                              {0.3, 0.4, "AX", ""},
                              {0.4, 0.45, "T", ""},
                              {0.45, 0.5, "S", ""}}};
  EXPECT_EQ(script, expected);
}

TEST(VoiceScript, WildEventsStayInsideTheSound) {
  const RawSpeech raw{sound(100, {{0, 100}}),
                      {word(0, -5, 1000000), phoneme(-50, "m"), phoneme(5000, "a"),
                       phoneme(50, "p"), word(0, 2000000000, 2000000000), phoneme(20, "i")}};
  const dam::Script script = make_voice_script(raw, kRate, "ab");
  EXPECT_TRUE(dam::check_script(script));
  EXPECT_DOUBLE_EQ(script.duration(), 0.1);
  EXPECT_TRUE(make_voice_script({}, kRate, "").phones.empty());
}

TEST(Transcript, Words) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(split_words("Hello, world!"), (Words{"Hello", "world"}));
  EXPECT_EQ(split_words("it\u2019s \u201Cmother-in-law\u201D \u2014 o'clock..."),
            (Words{"it's", "mother", "in", "law", "o'clock"}));
  EXPECT_EQ(split_words("\u00BFQu\u00E9? \u00ABOui\u00BB"), (Words{"Qu\u00E9", "Oui"}));
  EXPECT_TRUE(split_words(" -- ... \n").empty());
  EXPECT_EQ(strip_punctuation("'tis'"), "tis");
  EXPECT_EQ(strip_punctuation("!?"), "");
}

TEST(VoiceChoice, NamesTheNearest) {
  VoiceLists lists;
  lists.voices = {{"German", "de", "gmw/de", {}},
                  {"French (France)", "fr-fr", "roa/fr", {"fr"}},
                  {"English (America)", "en-us", "gmw/en-US", {"en"}},
                  {"Norwegian", "nb", "gmq/nb", {"no"}}};
  lists.variants = {"f3"};
  EXPECT_EQ(choose_voices("fr", lists)->voices.front().identifier, "roa/fr");
  EXPECT_EQ(choose_voices("no", lists)->voices.front().identifier, "gmq/nb");
  EXPECT_EQ(choose_voices("en", lists)->voices.front().identifier, "gmw/en-US");
  EXPECT_EQ(choose_voices("en-us+F3", lists)->voices.front().identifier, "gmw/en-US+f3");
  // Three letters, as media files have them.
  for (const char* code : {"fra", "fre", "FRA"}) {
    EXPECT_EQ(choose_voices(code, lists)->voices.front().identifier, "roa/fr") << code;
  }
  EXPECT_EQ(choose_voices("eng", lists)->voices.front().identifier, "gmw/en-US");
  const auto unknown = choose_voices("germ", lists);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("nearest are de (German)"), std::string::npos);
  EXPECT_FALSE(choose_voices("", lists));
  EXPECT_FALSE(choose_voices(std::string(100000, '-'), lists));
}

TEST(VoiceChoice, EndsWithoutEnglish) {
  VoiceLists lists;
  lists.voices = {{"German", "de", "gmw/de", {}}};
  for (const char* wanted : {"en", "en-us", "en_US", "en-gb-x", "en-"}) {
    const auto none = choose_voices(wanted, lists);
    ASSERT_FALSE(none) << wanted;
    EXPECT_NE(none.error().message.find("nearest are de (German)"), std::string::npos) << wanted;
  }
  lists.voices = {{"English (Great Britain)", "en-gb", "gmw/en", {"en"}}};
  EXPECT_EQ(choose_voices("en", lists)->voices.front().identifier, "gmw/en");
  lists.voices.clear();
  const auto none = choose_voices("en", lists);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("espeak-ng-data"), std::string::npos);
}

}  // namespace events_test
}  // namespace animeme::voice
