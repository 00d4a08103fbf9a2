// Transcripts with numbers, dates, amounts and abbreviations: the aligner hears how they are said.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/speech/voice/align_support.h"

namespace animeme::voice {
namespace align_readings_test {

using namespace align_support;  // NOLINT: as if they were here

// A token of a transcript, the words that say it, and the phones that are to be found.
struct Heard {
  const char *token, *first, *last, *phones;
};

struct Trial {
  const char *language, *spoken, *written;
  std::vector<Heard> heard;
};

// Where a word of the voice begins or ends; words of a script are phones in a row. The voice may
// name a long number by its beginning.
double time_of(const dam::Script& script, const std::string& word, bool end) {
  double time = -1;
  for (const dam::Phone& phone : script.phones) {
    const bool same = phone.word == word || (phone.word.size() > 4 && word.starts_with(phone.word));
    if (!same) continue;
    if (!end) return phone.start;
    time = phone.end;
  }
  return time;
}

void check(const Trial& trial) {
  VoiceOptions voice;
  voice.language = trial.language;
  const auto speech = speak_text(trial.spoken, voice);
  SKIP_WITHOUT_VOICE(speech);
  AlignOptions options;
  options.language = trial.language;
  const auto found = align(resample(speech->audio, kAlignRate), trial.written, options);
  ASSERT_TRUE(found) << trial.written << ": " << found.error().describe();
  for (const Heard& heard : trial.heard) {
    const AlignedWord* word = nullptr;
    for (const AlignedWord& one : found->words) {
      if (one.text == heard.token) word = &one;
    }
    ASSERT_NE(word, nullptr) << heard.token << " of " << trial.written;
    EXPECT_TRUE(word->said) << heard.token;
    std::string phones;
    for (const dam::Phone& phone : found->script.phones) {
      if (phone.word == heard.token) phones += (phones.empty() ? "" : " ") + phone.label;
    }
    // "forty" has a T in the dictionary, and a flap, D, as the voice says it.
    for (std::size_t at = 0; (at = phones.find("D IY", at)) != std::string::npos; ++at) {
      if (std::string_view(trial.language) == "en") phones.replace(at, 1, "T");
    }
    EXPECT_EQ(phones, heard.phones) << heard.token << " in '" << trial.spoken << "'";
    EXPECT_NEAR(word->start, time_of(speech->script, heard.first, false), 0.04) << heard.token;
    EXPECT_NEAR(word->end, time_of(speech->script, heard.last, true), 0.04) << heard.token;
  }
}

TEST(AlignReadings, EnglishNumbersAsTheyAreHeard) {
  SKIP_WITHOUT_ALIGNER();
  const Trial kTrials[] = {
      {"en",
       "In nineteen eighty two we paid five hundred dollars for three quarters of it fifty percent "
       "off",
       "In 1982 we paid $500 for 3/4 of it, 50 % off.",
       {{"1982", "nineteen", "two", "N AY N T IY N EY T IY T UW"},
        {"$500", "five", "dollars", "F AY V HH AH N D R IH D D AA L ER Z"},
        {"3/4", "three", "quarters", "TH R IY K W AO R T ER Z"},
        {"50 %", "fifty", "percent", "F IH F T IY P ER S EH N T"}}},
      {"en",
       "In one thousand nine hundred eighty two we paid six hundred for three over four of it",
       "In 1982 we paid $600 for 3/4 of it",
       {{"1982", "one", "two", "W AH N TH AW Z AH N D N AY N HH AH N D R AH D EY T IY T UW"},
        {"3/4", "three", "four", "TH R IY OW V ER F AO R"}}},
      {"en",
       "The bill was five dollars and fifty cents plus three ninety nine for tea",
       "The bill was $5.50 plus $3.99 for tea",
       {{"$5.50", "five", "cents", "F AY V D AA L ER Z AE N D F IH F T IY S EH N T S"},
        {"$3.99", "three", "nine", "TH R IY N AY N T IY N AY N"}}},
      {"en",
       "My friend was born on december fifth nineteen ninety but slept until three forty seven p m "
       "sharp",
       "My friend was born on 12/05/1990 but slept until 3:47pm sharp",
       {{"12/05/1990", "december", "ninety",
         "D IH S EH M B ER F IH F TH N AY N T IY N N AY N T IY"},
        {"3:47pm", "three", "m", "TH R IY F AO R T IY S EH V AH N P IY EH M"}}},
      {"en",
       "Henry the eighth ruled until fifteen forty seven",
       "Henry VIII ruled until 1547",
       {{"1547", "fifteen", "seven", "F IH F T IY N F AO R T IY S EH V AH N"}}},
  };
  for (const Trial& trial : kTrials) check(trial);
}

TEST(AlignReadings, OtherLanguages) {
  SKIP_WITHOUT_ALIGNER();
  const Trial kTrials[] = {
      {"de",
       "Das kostet eintausendzweihundertvierunddreißig Euro oder zweieinhalb Millionen Dollar",
       "Das kostet 1.234 € oder 2,5 Mio. $",
       {{"1.234 €", "eintausendzweihundertvierunddreißig", "Euro",
         "AY N T AW Z AH N T T S V AY HH UH N D AH T V IY R UH N D D AY S IH Y AO UH R OW"},
        {"2,5 Mio. $", "zweieinhalb", "Dollar",
         "T S V AY AY N HH AA L P M IH L Y OW N AH N D AO L AA D"}}},
      {"de",
       "Wir treffen uns um halb zehn und zahlen bar",
       "Wir treffen uns um 9:30 und zahlen bar",
       {{"9:30", "halb", "zehn", "HH AA L P T S EY N"}}},
      {"fr",
       "Il a payé douze euros cinquante et trois quarts du prix soit vingt pour cent",
       "Il a payé 12,50 € et 3/4 du prix soit 20 %",
       {{"12,50 €", "douze", "cinquante", "D UW Z UH G OW S EH K AA T"},
        {"3/4", "trois", "quarts", "T G AA K AA G"},
        {"20 %", "vingt", "cent", "V EH P UW G S AA"}}},
      {"es",
       "El cincuenta por ciento es tres cuartos",
       "El 50 % es 3/4",
       {{"50 %", "cincuenta", "ciento", "TH IY N K W EH N T AA P OW D TH Y EH N T OW"},
        {"3/4", "tres", "cuartos", "T D EY S K W AA D T OW S"}}},
  };
  for (const Trial& trial : kTrials) check(trial);
}

// The same text, said in another way.
TEST(AlignReadings, TheVariantIsTheOneThatIsSaid) {
  SKIP_WITHOUT_ALIGNER();
  for (const char* said : {"twenty twenty four", "two thousand and twenty four",
                           "two thousand twenty four", "two oh two four"}) {
    const auto speech = speak_text(std::string("I bought it back in ") + said + " for my mother");
    SKIP_WITHOUT_VOICE(speech);
    const media::Pcm audio = resample(speech->audio, kAlignRate);
    const auto in_figures = align(audio, "I bought it back in 2024 for my mother");
    ASSERT_TRUE(in_figures) << said << ": " << in_figures.error().describe();
    const auto in_words =
        align(audio, std::string("I bought it back in ") + said + " for my mother");
    ASSERT_TRUE(in_words) << said << ": " << in_words.error().describe();
    ASSERT_EQ(in_figures->words.size(), 9u);
    EXPECT_EQ(in_figures->words[5].text, "2024");
    EXPECT_NEAR(in_figures->words[5].start, in_words->words[5].start, 0.04) << said;
    const std::size_t last = in_words->words.size() - 4;
    EXPECT_NEAR(in_figures->words[5].end, in_words->words[last].end, 0.04) << said;
    EXPECT_TRUE(in_figures->inserted.empty()) << said;
  }
}

TEST(AlignReadings, WordsStayAsWritten) {
  SKIP_WITHOUT_ALIGNER();
  const auto speech = speak_text("doctor Smith paid twelve hundred dollars on may the fifth");
  SKIP_WITHOUT_VOICE(speech);
  const auto found = align(resample(speech->audio, kAlignRate),
                           "Dr. Smith paid $1,200 (on May 5th).", everything());
  ASSERT_TRUE(found) << found.error().describe();
  std::vector<std::string> words;
  for (const AlignedWord& word : found->words) words.push_back(word.text);
  EXPECT_EQ(words,
            (std::vector<std::string>{"Dr.", "Smith", "paid", "$1,200", "on", "May", "5th"}));
}

}  // namespace align_readings_test
}  // namespace animeme::voice
