// A sentence a language in its own script: spoken by its voice alone, all words named in order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/captions.h"
#include "dam/script/words.h"
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
      // The voice reads Thai letter by letter, and is warned of.
      if (std::string_view(one.language) != "th") {
        EXPECT_THAT(speech->warnings, testing::IsEmpty()) << one.text;
      }
      std::string first;
      std::size_t next = 0;
      for (const dam::Phone& phone : speech->script.phones) {
        if (first.empty() && phone.label != dam::kSilence) first = phone.label;
        if (next < one.words.size() && phone.word.starts_with(one.words[next])) ++next;
      }
      EXPECT_EQ(first, one.first) << one.text;
      EXPECT_EQ(next, one.words.size()) << one.text << ": a word is missing in the script";
    }
  }
}

TEST(OwnScript, WritingWithoutVowelsIsWarnedOf) {
  SKIP_WITHOUT_SCRIPTS();
  const struct {
    const char *language, *text;
    bool warns;
  } texts[] = {
      {"he", "הילדים משחקים בחצר ואמא קוראת ספר על הספסל", true},
      {"he", "הַיְּלָדִים מְשַׂחֲקִים בֶּחָצֵר וְאִמָּא קוֹרֵאת סֵפֶר עַל הַסַּפְסָל", false},
      {"cs", "Strč prst skrz krk, prv zmrzl vrch a krt hrd brkl.", false},
      {"ka", "მწვრთნელი ფრთხილად ხსნის წიგნს", false},
      {"ar", "ذهب الولد إلى المدرسة في الصباح الباكر", false},
      {"pl", "W Szczebrzeszynie chrząszcz brzmi w trzcinie", false},
      {"he", "כן", false},  // too little to tell
  };
  for (const auto& one : texts) {
    const auto speech = speak(one.text, one.language);
    ASSERT_TRUE(speech) << one.text << ": " << speech.error().describe();
    EXPECT_EQ(std::any_of(speech->warnings.begin(), speech->warnings.end(),
                          [](const std::string& text) {
                            return text.find("hardly any vowels") != std::string::npos;
                          }),
              one.warns)
        << one.text;
  }
}

// espeak-ng's Thai voice takes two of the most frequent vowel signs for consonants: "ดี" is D S.
TEST(OwnScript, VowelSignsThatAreSpokenAsConsonantsAreWarnedOf) {
  SKIP_WITHOUT_SCRIPTS();
  const struct {
    const char *language, *text;
    bool warns;
  } texts[] = {
      {"th", "สวัสดีครับ วันนี้อากาศดีมาก เราไปเดินเล่นที่สวนสาธารณะกันไหม", true},
      {"th", "ประเทศไทยเป็นประเทศที่ตั้งอยู่ในเอเชียตะวันออกเฉียงใต้ มีกรุงเทพมหานครเป็นเมืองหลวง", true},
      {"th", "งู หมู ปู", false},  // signs that it knows
      {"hi", "सभी मनुष्यों को गौरव और अधिकारों के मामले में जन्मजात स्वतन्त्रता और समानता प्राप्त है", false},
      {"bn", "সমস্ত মানুষ স্বাধীনভাবে সমান মর্যাদা এবং অধিকার নিয়ে জন্মগ্রহণ করে", false},
      {"ta", "மனிதப் பிறிவியினர் சகலரும் சுதந்திரமாகவே பிறக்கின்றனர்", false},
      {"ml", "മനുഷ്യരെല്ലാവരും തുല്യാവകാശങ്ങളോടും അന്തസ്സോടും സ്വാതന്ത്ര്യത്തോടുംകൂടി ജനിച്ചിട്ടുള്ളവരാണ്", false},
      {"si",
       "සියලු මනුෂ්‍යයෝ නිදහස්ව උපත ලබා "
       "ඇත",
       false},
      {"te", "ప్రతిపత్తిస్వత్వముల విషయమున మానవులెల్లరును జన్మతః స్వతంత్రులును సమానులును నగుదురు", false},
      {"ar", "ذهب الولد إلى المدرسة في الصباح الباكر", false},
      {"en", "Good morning", false},
  };
  for (const auto& one : texts) {
    const auto speech = speak(one.text, one.language);
    ASSERT_TRUE(speech) << one.text << ": " << speech.error().describe();
    EXPECT_EQ(std::any_of(speech->warnings.begin(), speech->warnings.end(),
                          [](const std::string& text) {
                            return text.find("vowel signs of this text") != std::string::npos;
                          }),
              one.warns)
        << one.text;
  }
}

TEST(OwnScript, WordsBehindAnAbbreviationAreNamed) {
  SKIP_WITHOUT_SCRIPTS();
  const auto speech = speak("Das ist z. B. so.", "de");
  ASSERT_TRUE(speech) << speech.error().describe();
  const auto words = dam::words_of(speech->script);
  ASSERT_FALSE(words.empty());
  EXPECT_EQ(words.back().text, "so.");
}

// The words of a script with blanks between them.
std::string text_of(const dam::Script& script) {
  std::string text;
  for (const dam::ScriptWord& word : dam::words_of(script)) {
    if (dam::blank_between(text, word.text)) text += ' ';
    text += word.text;
  }
  return text;
}

TEST(OwnScript, WordsAreAsWritten) {
  SKIP_WITHOUT_SCRIPTS();
  using Words = std::vector<std::string>;
  const std::pair<const char*, Words> texts[] = {
      {"I can't say it's Bob's.", {"I", "can't", "say", "it's", "Bob's."}},
      {"Would have gone, rock-and-roll!", {"Would", "have", "gone,", "rock-and-roll!"}},
      {"(IBM's) \"mainframes\" cost $5.50 -- really?",
       {"(IBM's)", "\"mainframes\"", "cost", "$5.50 --", "really?"}},
      {"No no no, bye bye.", {"No", "no", "no,", "bye", "bye."}},
  };
  for (const auto& [text, words] : texts) {
    const auto speech = speak(text, "en");
    ASSERT_TRUE(speech) << speech.error().describe();
    Words found;
    for (const dam::ScriptWord& word : dam::words_of(speech->script)) found.push_back(word.text);
    EXPECT_EQ(found, words) << text;
  }
}

// Property: the words of a script are the text, each place of it once. The sentences are made of
// what voices announce in odd ways: apostrophes, hyphens, numbers, amounts, abbreviations, signs.
TEST(OwnScript, WordsTogetherAreTheText) {
  SKIP_WITHOUT_SCRIPTS();
  keep_voices();
  const std::pair<const char*, std::vector<const char*>> languages[] = {
      {"en",
       {"don't", "Bob's", "IBM's", "21st", "rock-and-roll", "Dr. Smith", "$5.50", "would have",
        "2024", "a.m.", "e.g.", "\"quoted\"", "50%", "of the", "it'll", "3/4", "O'Neill", "--"}},
      {"de",
       {"geht's", "z. B.", "12,50 €", "2024", "Dr. Müller", "„so“", "E-Mail", "am 3. Mai",
        "100 km/h", "nicht", "usw.", "9:30 Uhr", "1.000.000", "Nord-Süd-Weg", "–"}},
      {"fr",
       {"j'aime", "l'amour", "aujourd'hui", "qu'est-ce", "12,50 €", "allez-vous", "« oui »",
        "1 234", "M. Dupont", "d'accord", "n'est", "20 %", "XIVe", "9h30"}},
      {"es", {"¿qué?", "¡hola!", "12,50 €", "Sr. García", "2024", "por favor", "EE. UU.", "1.ª"}},
      {"it", {"l'uomo", "dell'arte", "c'è", "12,50 €", "perché", "un po'", "2024", "sig. Rossi"}},
      {"pt", {"d'água", "12,50 €", "Sr. Silva", "guarda-chuva", "2024", "disse-me"}},
      {"nl", {"'s avonds", "foto's", "€ 12,50", "bijv.", "zo'n", "2024", "auto-ongeluk"}},
      {"sv", {"t.ex.", "12 kr", "2024", "bl.a.", "EU:s", "kl. 9.30"}},
      {"pl", {"np.", "12,50 zł", "2024 r.", "dr. Nowak", "m.in.", "biało-czerwony"}},
      {"ru", {"12,50 руб.", "2024 г.", "т. е.", "кто-нибудь", "«да»", "д-р", "из-за"}},
  };
  std::mt19937 random(300);
  for (const auto& [language, parts] : languages) {
    for (int i = 0; i < 30; ++i) {
      std::string text;
      for (unsigned n = 3 + unsigned(random() % 5); n > 0; --n) {
        text += (text.empty() ? "" : " ") + std::string(parts[random() % parts.size()]);
        if (n > 1 && random() % 5 == 0 && text.back() != '-') text += ",";
      }
      text += random() % 2 == 0 ? "." : "?";
      const auto speech = speak(text, language);
      ASSERT_TRUE(speech) << language << ": " << text << ": " << speech.error().describe();
      EXPECT_EQ(text_of(speech->script), text) << language;
    }
  }
}

TEST(OwnScript, SentencesOfSsmlPartWords) {
  SKIP_WITHOUT_SCRIPTS();
  const auto speech = speak(
      "<speak><s>Hello</s><s>wor<emphasis>ld</emphasis></s> <sub alias=\"World Wide "
      "Web\">WWW</sub>."
      "</speak>",
      "en");
  if (!speech && speech.error().code == Code::unsupported)
    GTEST_SKIP() << speech.error().describe();
  ASSERT_TRUE(speech) << speech.error().describe();
  EXPECT_EQ(text_of(speech->script), "Hello world WWW.");
}

TEST(OwnScript, ChineseAndJapaneseWordsAreTheText) {
  SKIP_WITHOUT_SCRIPTS();
  for (const auto& [language, text] : {std::pair{"zh", "你好，我是小明。今天天气很好！"},
                                       std::pair{"ja", "こんにちは、今日は東京へ行きます。"}}) {
    const auto speech = speak(text, language);
    if (!speech && speech.error().code == Code::not_found) continue;  // no dictionary
    ASSERT_TRUE(speech) << speech.error().describe();
    EXPECT_EQ(text_of(speech->script), text);
    EXPECT_GT(dam::words_of(speech->script).size(), 3u);
  }
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

// espeak-ng leaves out breaks that are not between words.
TEST(OwnScript, BreaksAroundTheWordsAreSilence) {
  SKIP_WITHOUT_SCRIPTS();
  const auto plain = speak("<speak><p><s>One.</s></p></speak>", "en");
  const auto breaks = speak(
      "<speak><mark name='a'/><break time='1s'/><mark name='b'/> <break time='500ms'/>"
      "<p><s>One.</s></p><break time='2s'/><mark name='c'/></speak>",
      "en");
  if (!plain && plain.error().code == Code::unsupported) GTEST_SKIP() << plain.error().describe();
  ASSERT_TRUE(plain && breaks);
  const auto words_of = [](const Speech& speech) {
    const std::vector<dam::Phone>& phones = speech.script.phones;
    return std::pair(phones.front().end, phones.back().start);
  };
  const auto [first, last] = words_of(*plain);
  const auto [later, end] = words_of(*breaks);
  EXPECT_NEAR(later - first, 1.5, 0.01);
  EXPECT_NEAR(end - last, 1.5, 0.01);
  EXPECT_NEAR(breaks->audio.duration() - plain->audio.duration(), 3.5, 0.01);
  ASSERT_EQ(breaks->marks.size(), 3u);
  EXPECT_NEAR(breaks->marks[0].time, later - 1.5, 0.05);
  EXPECT_NEAR(breaks->marks[1].time, later - 0.5, 0.05);
  EXPECT_GE(breaks->marks[2].time, end + 2);
  EXPECT_LT(breaks->marks[2].time, end + 2.7) << "the end of a paragraph has a pause of its own";

  std::string long_breaks = "<speak>";
  for (int i = 0; i < 61; ++i) long_breaks += "<break time='10s'/>";
  const auto refused = speak(long_breaks + "One.</speak>", "en");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::out_of_range);
}

TEST(OwnScript, MoodsHaveTheTimesOfTheirWords) {
  SKIP_WITHOUT_SCRIPTS();
  const auto start_of = [](const Speech& speech, std::string_view word) {
    for (const dam::Phone& phone : speech.script.phones)
      if (phone.word.starts_with(word)) return phone.start;
    ADD_FAILURE() << "no word " << word;
    return 0.0;
  };
  const auto chat = speak("Good morning. What a lovely day 😀 But my cat has died. 😢", "en");
  ASSERT_TRUE(chat) << chat.error().describe();
  ASSERT_EQ(chat->moods.size(), 2u);
  EXPECT_EQ(chat->moods[0].mood->name, "joy");
  EXPECT_NEAR(chat->moods[0].start, start_of(*chat, "What"), 0.06);
  EXPECT_NEAR(chat->moods[0].end, start_of(*chat, "But"), 0.06);
  EXPECT_EQ(chat->moods[1].mood->name, "sadness");
  EXPECT_GT(chat->moods[1].end, start_of(*chat, "died"));
  for (const dam::Phone& phone : chat->script.phones)
    EXPECT_EQ(phone.word.find("grin"), std::string::npos) << "the name of an emoji is not said";

  const auto smiley = speak("This is nice :-) is it not?", "en"),
             plain = speak("This is nice is it not?", "en");
  ASSERT_TRUE(smiley && plain);
  EXPECT_EQ(smiley->script.phones.size(), plain->script.phones.size());
  EXPECT_EQ(smiley->moods.size(), 1u);

  const auto ssml = speak(
      "<speak>One two. <mstts:express-as style='angry'>Three four!</mstts:express-as> "
      "Five.</speak>",
      "en");
  if (!ssml && ssml.error().code == Code::unsupported) GTEST_SKIP() << ssml.error().describe();
  ASSERT_TRUE(ssml) << ssml.error().describe();
  ASSERT_EQ(ssml->moods.size(), 2u) << "the mark intensifies";
  EXPECT_EQ(ssml->moods[0].mood->name, "anger");
  EXPECT_NEAR(ssml->moods[0].start, start_of(*ssml, "Three"), 0.06);
  EXPECT_NEAR(ssml->moods[0].end, start_of(*ssml, "Five"), 0.06);
  EXPECT_FALSE(ssml->moods[1].mood);
  EXPECT_GT(ssml->moods[1].gain, 1);
}

}  // namespace languages_test
}  // namespace animeme::voice
