// A sentence a language in its own script: spoken by its voice alone, all words named in order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace languages_test {

#define SKIP_WITHOUT_SCRIPTS()                                         \
  if (const auto voices_here = list_voices();                          \
      !voices_here && voices_here.error().code == Code::unsupported) { \
    GTEST_SKIP() << voices_here.error().describe();                    \
  }                                                                    \
  if (!text::unicode_here()) GTEST_SKIP() << "built without ICU"

Result<Speech> speak(const std::string& text, const std::string& language) {
  VoiceOptions options;
  options.language = language;
  return speak_text(text, options);
}

struct Sentence {
  const char* language;            // of espeak-ng
  const char* text;                // a greeting
  std::vector<const char*> words;  // of the script
  const char* first;               // the sound that its first word begins with, as its speakers say
  bool told = true;                // by --lang auto: its letters, or its script, are its own
};

TEST(OwnScript, ASentenceALanguage) {
  SKIP_WITHOUT_SCRIPTS();
  const Sentence sentences[] = {
      {"ru", "Привет, сегодня хорошая погода.", {"Привет", "сегодня", "погода"}, "P"},
      {"uk", "Привіт, сьогодні гарна погода.", {"Привіт", "сьогодні", "погода"}, "P"},
      {"bg", "Добро утро, времето е хубаво.", {"Добро", "утро", "хубаво"}, "D", false},
      {"sr", "Добар дан, како сте?", {"Добар", "дан", "сте"}, "D", false},
      {"el", "Καλημέρα, τι κάνετε;", {"Καλημέρα", "τι", "κάνετε"}, "K"},
      {"ar", "مرحبا، كيف حالك اليوم؟", {"مرحبا", "كيف", "اليوم"}, "M"},
      {"fa", "سلام، حال شما چطور است؟", {"سلام", "حال", "است"}, "S"},
      {"ur", "سلام، آپ کیسے ہیں؟", {"سلام", "آپ", "ہیں"}, "S"},
      {"he", "שלום, מה שלומך?", {"שלום", "מה", "שלומך"}, "SH"},
      {"hi", "नमस्ते, आप कैसे हैं?", {"नमस्ते", "आप", "हैं"}, "N"},
      {"bn", "নমস্কার, আপনি কেমন আছেন?", {"নমস্কার", "আপনি", "আছেন"}, "N"},
      {"ta", "வணக்கம், எப்படி?", {"வணக்கம்", "எப்படி"}, "V"},
      {"te", "నమస్కారం, మీరు ఎలా ఉన్నారు?", {"నమస్కారం", "మీరు", "ఉన్నారు"}, "N"},
      {"ml", "നമസ്കാരം, സുഖമാണോ?", {"നമസ്കാരം", "സുഖമാണോ"}, "N"},
      {"ka", "გამარჯობა, როგორ ხარ?", {"გამარჯობა", "როგორ", "ხარ"}, "G"},
      {"hy", "Բարև, ինչպես ես:", {"Բարև", "ինչպես", "ես"}, "B"},
      {"am", "ሰላም፣ እንዴት ነህ?", {"ሰላም", "እንዴት", "ነህ"}, "S"},
      // Of some Korean words espeak-ng 1.51 tells no place: they are named like the one before.
      {"ko", "만나서 반갑습니다.", {}, "M"},
      {"th", "สวัสดีครับ", {"สวัสดีครับ"}, "S"},
      {"de", "Grüß Gott, wie geht es Ihnen?", {"Grüß", "Gott", "Ihnen"}, "G", false},
      {"fr", "Bonjour, ça va bien ?", {"Bonjour", "va", "bien"}, "B", false},
      {"tr", "Günaydın, nasılsınız?", {"Günaydın", "nasılsınız"}, "G", false},
  };
  for (const Sentence& one : sentences) {
    for (const std::string& language : {std::string(one.language), std::string("auto")}) {
      if (language == "auto" && !one.told) continue;
      const auto speech = speak(one.text, language);
      ASSERT_TRUE(speech) << one.text << ": " << speech.error().describe();
      ASSERT_EQ(speech->languages.size(), 1u) << one.text;
      EXPECT_TRUE(speech->languages[0].language.starts_with(one.language)) << one.text;
      EXPECT_FALSE(speech->languages[0].by_itself) << one.text;
      EXPECT_THAT(speech->warnings, testing::IsEmpty()) << one.text;
      std::string first;
      std::size_t next = 0;
      for (const dam::Phone& phone : speech->script.phones) {
        if (first.empty() && phone.label != dam::kSilence) first = phone.label;
        if (next < one.words.size() && phone.word == one.words[next]) ++next;
      }
      EXPECT_EQ(first, one.first) << one.text;
      EXPECT_EQ(next, one.words.size()) << one.text << ": a word is missing in the script";
    }
  }
}

TEST(OwnScript, WordsBehindAnAbbreviationAreNamed) {
  SKIP_WITHOUT_SCRIPTS();
  const auto speech = speak("Das ist z. B. so.", "de");
  ASSERT_TRUE(speech) << speech.error().describe();
  std::string last;
  for (const dam::Phone& phone : speech->script.phones) {
    if (phone.label != dam::kSilence) last = phone.word;
  }
  EXPECT_EQ(last, "so");
}

TEST(OwnScript, WhereTheLanguageChanges) {
  SKIP_WITHOUT_SCRIPTS();
  const auto speech = speak("Hello привет", "en+ru");
  ASSERT_TRUE(speech) << speech.error().describe();
  ASSERT_EQ(speech->languages.size(), 2u);
  EXPECT_EQ(speech->languages[0].text, "Hello");
  EXPECT_EQ(speech->languages[1].language, "ru");
  EXPECT_EQ(speech->languages[1].text, "привет");
  EXPECT_GT(speech->languages[1].start, 0.3);
  EXPECT_DOUBLE_EQ(speech->languages[0].end, speech->languages[1].start);
  EXPECT_DOUBLE_EQ(speech->languages[1].end, speech->audio.duration());
}

TEST(OwnScript, MarksOfSsmlHaveTimes) {
  SKIP_WITHOUT_SCRIPTS();
  const auto speech = speak(
      "<speak>One<mark name=\"a\"/><break time=\"600ms\"/>two<mark name=\"b\"/></speak>", "en");
  if (!speech && speech.error().code == Code::unsupported)
    GTEST_SKIP() << speech.error().describe();
  ASSERT_TRUE(speech) << speech.error().describe();
  ASSERT_EQ(speech->marks.size(), 2u);
  EXPECT_EQ(speech->marks[0].name, "a");
  EXPECT_EQ(speech->marks[1].name, "b");
  EXPECT_GT(speech->marks[1].time, speech->marks[0].time + 0.6);
}

}  // namespace languages_test
}  // namespace animeme::voice
