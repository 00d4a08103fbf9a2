#include "tools/speech/voice/voice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "dam/script/phones.h"
#include "tests/support/sanitized.h"

namespace animeme::voice {
namespace voice_test {

using testing::HasSubstr;

// The voice is an optional part: without it these tests have nothing to test.
#define SKIP_WITHOUT_VOICES()                                          \
  if (const auto voices_here = list_voices();                          \
      !voices_here && voices_here.error().code == Code::unsupported) { \
    GTEST_SKIP() << voices_here.error().describe();                    \
  }

Speech speak(const std::string& text, const std::string& language = "en") {
  VoiceOptions options;
  options.language = language;
  auto speech = speak_text(text, options);
  if (!speech) {
    ADD_FAILURE() << language << ": " << speech.error().describe();
    return {};
  }
  return *std::move(speech);
}

std::vector<std::string> sounds(const dam::Script& script) {
  std::vector<std::string> labels;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label != dam::kSilence) labels.push_back(phone.label);
  }
  return labels;
}

// Root mean square of the sound from `start` to `end` seconds.
double level(const media::Pcm& audio, double start, double end) {
  const auto first = std::size_t(start * audio.sample_rate);
  const auto last = std::min(std::size_t(end * audio.sample_rate), audio.samples.size());
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    sum += double(audio.samples[i]) * double(audio.samples[i]);
  }
  return last > first ? std::sqrt(sum / double(last - first)) : 0;
}

void expect_well_formed(const Speech& speech) {
  const auto good = dam::check_script(speech.script);
  ASSERT_TRUE(good) << good.error().describe();
  EXPECT_EQ(speech.script.phones.front().start, 0);
  EXPECT_DOUBLE_EQ(speech.script.duration(), speech.audio.duration());
  for (std::size_t i = 1; i < speech.script.phones.size(); ++i) {
    const dam::Phone& phone = speech.script.phones[i];
    EXPECT_EQ(phone.start, speech.script.phones[i - 1].end);
    EXPECT_FALSE(phone.label == dam::kSilence &&
                 speech.script.phones[i - 1].label == dam::kSilence);
  }
}

TEST(Speak, HelloWorld) {
  SKIP_WITHOUT_VOICES();
  const Speech speech = speak("Hello world");
  expect_well_formed(speech);
  EXPECT_EQ(speech.voice, "English (America)");
  EXPECT_THAT(sounds(speech.script), testing::ElementsAre("HH", testing::AnyOf("AX", "AH", "EH"),
                                                          "L", "OW", "W", "ER", "L", "D"));
  const dam::Phone& first = speech.script.phones.front();
  const dam::Phone& last = speech.script.phones.back();
  EXPECT_EQ(first.label, "SIL");
  EXPECT_GE(first.duration(), 0.25);
  EXPECT_EQ(last.label, "SIL");
  EXPECT_GE(last.duration(), 0.4);
  EXPECT_EQ(level(speech.audio, 0, 0.24), 0);
  int number = 0;
  for (const dam::Phone& phone : speech.script.phones) {
    if (phone.label == dam::kSilence) continue;
    EXPECT_EQ(phone.word, number++ < 4 ? "Hello" : "world") << phone.label;
    if (dam::find_phone(phone.label)->vowel) {
      EXPECT_GT(level(speech.audio, phone.start, phone.end), 0.02) << phone.label;
    }
  }
}

TEST(Speak, EveryCallGivesTheSameSamples) {
  SKIP_WITHOUT_VOICES();
  const Speech first = speak("The quick brown fox.");
  speak("Etwas ganz anderes", "de");
  const Speech second = speak("The quick brown fox.");
  EXPECT_EQ(first.audio.samples, second.audio.samples);
  EXPECT_EQ(first.script, second.script);
}

TEST(Speak, FromSeveralThreads) {
  if (test::kAddressSanitizer) {
    GTEST_SKIP() << "the sanitizer's allocator may be locked by another thread at a fork";
  }
  SKIP_WITHOUT_VOICES();
  const Speech expected = speak("one two three");
  std::vector<Speech> spoken(4);
  std::vector<std::thread> threads;
  for (Speech& speech : spoken) threads.emplace_back([&] { speech = speak("one two three"); });
  for (std::thread& thread : threads) thread.join();
  for (const Speech& speech : spoken) EXPECT_EQ(speech.audio.samples, expected.audio.samples);
}

TEST(Speak, StopsBeginAtTheirClosure) {
  SKIP_WITHOUT_VOICES();
  const Speech speech = speak("Papa happy apple puppy keeper appeal");
  int stops = 0;
  for (const dam::Phone& phone : speech.script.phones) {
    if (phone.label != "P") continue;
    ++stops;
    const double closure = phone.start + 0.5 * phone.duration();
    EXPECT_LT(level(speech.audio, phone.start, closure), 0.002) << phone.word;
    EXPECT_GT(level(speech.audio, closure, phone.end), 0.005) << phone.word;
    EXPECT_GT(phone.duration(), 0.05) << phone.word;
  }
  EXPECT_EQ(stops, 8);
}

TEST(Speak, PausesAreSilence) {
  SKIP_WITHOUT_VOICES();
  const Speech speech = speak("Yes. No.");
  expect_well_formed(speech);
  int pauses = 0;
  for (const dam::Phone& phone : speech.script.phones) {
    if (phone.label != dam::kSilence) continue;
    ++pauses;
    EXPECT_LT(level(speech.audio, phone.start + 0.05, phone.end), 0.003);
  }
  EXPECT_EQ(pauses, 3);
}

TEST(Speak, ManyLanguages) {
  SKIP_WITHOUT_VOICES();
  struct Case {
    const char* language;
    const char* text;
    std::vector<std::string> contains;
  };
  const Case cases[] = {
      {"de", "Guten Morgen, schöne Füße", {"G", "M", "SH", "UW", "S"}},
      {"fr", "Bonjour le monde, une rue", {"B", "ZH", "M", "UW"}},
      {"it", "Buongiorno a tutti", {"B", "JH", "T"}},
      {"es", "Buenos días, señor", {"B", "D", "N"}},
      {"fi", "Hyvää päivää", {"HH", "UW", "V", "AE", "P"}},
      {"pl", "Dzień dobry, Szczecin", {"D", "B", "SH", "CH"}},
      {"pt-br", "Bom dia, São Paulo", {"B", "S", "P"}},
      {"ru", "Привет, мир", {"P", "V", "M"}},
      {"ja", "こんにちは", {"K", "N"}},
      {"cs", "Dobrý den, řeka", {"D", "B", "ZH"}},
      {"tr", "Günaydın", {"UW", "N", "D"}},
      {"hi", "नमस्ते", {"N", "M", "S"}},
      {"ky", "Саламатсызбы", {"S", "L", "M"}},
      {"cmn-latn-pinyin", "ni3 hao3", {"N", "AW"}},
      {"en-gb-scotland", "a wee mouse", {"W", "M", "S"}},
  };
  for (const Case& c : cases) {
    const Speech speech = speak(c.text, c.language);
    expect_well_formed(speech);
    const auto labels = sounds(speech.script);
    for (const std::string& label : c.contains) {
      EXPECT_THAT(labels, testing::Contains(label)) << c.language;
    }
  }
}

TEST(Speak, EveryVoiceSpeaksKnownLabels) {
  SKIP_WITHOUT_VOICES();
  const auto voices = list_voices();
  ASSERT_GE(voices->size(), 100u);
  int silent = 0;
  for (const VoiceInfo& voice : *voices) {
    VoiceOptions options;
    options.language = voice.identifier;
    const auto speech = speak_text("1 2 3", options);
    if (!speech) {  // a few voices have no numbers
      EXPECT_EQ(speech.error().code, Code::invalid_argument) << speech.error().describe();
      ++silent;
      continue;
    }
    // Mandarin is read as pinyin, by the other voice.
    EXPECT_EQ(speech->voice,
              voice.identifier == "sit/cmn" ? std::string("Chinese (Mandarin)") : voice.name);
    expect_well_formed(*speech);
    EXPECT_GE(sounds(speech->script).size(), 3u) << voice.identifier;
  }
  EXPECT_LT(silent, 10);
}

TEST(Speak, RateAndPitchAreUsed) {
  SKIP_WITHOUT_VOICES();
  VoiceOptions slow, fast;
  slow.words_per_minute = 100;
  fast.words_per_minute = 300;
  const auto slow_speech = speak_text("one two three four five", slow);
  const auto fast_speech = speak_text("one two three four five", fast);
  ASSERT_TRUE(slow_speech && fast_speech);
  EXPECT_GT(slow_speech->audio.duration(), 1.5 * fast_speech->audio.duration());
  VoiceOptions high;
  high.pitch = 90;
  const auto high_speech = speak_text("one", high);
  ASSERT_TRUE(high_speech);
  EXPECT_NE(high_speech->audio.samples, speak("one").audio.samples);
}

TEST(Speak, NoSilenceAround) {
  SKIP_WITHOUT_VOICES();
  VoiceOptions options;
  options.lead_silence = options.tail_silence = 0;
  const auto speech = speak_text("papa", options);
  ASSERT_TRUE(speech);
  expect_well_formed(*speech);
}

TEST(Speak, VoicesAreFoundBySeveralNames) {
  SKIP_WITHOUT_VOICES();
  EXPECT_EQ(speak("a", "EN").voice, "English (America)");
  EXPECT_EQ(speak("a", "en_GB").voice, "English (Great Britain)");
  EXPECT_EQ(speak("a", "fr").voice, "French (France)");
  EXPECT_EQ(speak("a", "de-AT").voice, "German");
  EXPECT_EQ(speak("a", "german").voice, "German");
  EXPECT_EQ(speak("a", "gmw/de").voice, "German");
  EXPECT_NE(speak("a", "en-us+f3").audio.samples, speak("a", "en-us").audio.samples);
}

TEST(Speak, RefusesWithAReason) {
  SKIP_WITHOUT_VOICES();
  EXPECT_EQ(speak_text("").error().code, Code::invalid_argument);
  EXPECT_EQ(speak_text(" \t\n").error().code, Code::invalid_argument);
  EXPECT_EQ(speak_text("...").error().code, Code::invalid_argument);
  EXPECT_EQ(speak_text(std::string(3, '\0')).error().code, Code::invalid_argument);
  EXPECT_EQ(speak_text(std::string(100001, 'a')).error().code, Code::out_of_range);
  VoiceOptions options;
  options.language = "germ";
  const auto unknown = speak_text("hi", options);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Code::not_found);
  EXPECT_THAT(unknown.error().message, HasSubstr("de (German)"));
  options.language = "en-us+nobody";
  EXPECT_EQ(speak_text("hi", options).error().code, Code::not_found);
  options = {};
  options.words_per_minute = 79;
  EXPECT_THAT(speak_text("hi", options).error().message, HasSubstr("80 to 450"));
  options = {};
  options.tail_silence = std::nan("");
  EXPECT_EQ(speak_text("hi", options).error().code, Code::invalid_argument);
  options = {};
  options.data_path = "/nowhere";
  const auto no_data = speak_text("hi", options);
  ASSERT_FALSE(no_data);
  EXPECT_EQ(no_data.error().code, Code::not_found);
  EXPECT_THAT(no_data.error().message, HasSubstr("espeak-ng-data"));
}

TEST(Speak, HostileText) {
  SKIP_WITHOUT_VOICES();
  const std::string texts[] = {std::string("a\0b", 3),       "[[p@'a]] %s%n",
                               std::string(2000, 'a'),       "\xF4\x8F\xBF\xBF ok",
                               std::string(300, '9') + " x", "hi \xE2\x80\xAE there"};
  for (const std::string& text : texts) expect_well_formed(speak(text));
  // Chinese by its bytes, SSML without an end, scripts of other voices.
  for (const char* text :
       {"\xFF\xFE broken \xC3 utf", "<speak><voice name='x'>hi</voice>", "日本語 العربية עברית"}) {
    const auto refused = speak_text(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_TRUE(refused.error().code == Code::invalid_argument ||
                refused.error().code == Code::syntax)
        << refused.error().describe();
  }
}

TEST(Pronounce, WordsOneByOne) {
  SKIP_WITHOUT_VOICES();
  const auto words = pronounce({"zorblax", "shoe"});
  ASSERT_TRUE(words) << words.error().describe();
  ASSERT_EQ(words->size(), 2u);
  EXPECT_THAT((*words)[0], testing::ElementsAre("Z", "AO", "R", "B", "L", testing::_, "K", "S"));
  EXPECT_THAT((*words)[1], testing::ElementsAre("SH", "UW"));
}

}  // namespace voice_test
}  // namespace animeme::voice
