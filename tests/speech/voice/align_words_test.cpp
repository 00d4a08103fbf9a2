// Words that are said and words that are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/speech/voice/align_support.h"

namespace animeme::voice {
namespace align_words_test {

using namespace align_support;  // NOLINT: as if they were here
using testing::HasSubstr;

TEST(AlignWords, WordsLeftOutAndPutInAreTold) {
  SKIP_WITHOUT_ALIGNER();
  const auto speech = speak_text("please put the small blue book on the table by the window");
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm audio = resample(speech->audio, kAlignRate);
  const auto more =
      align(audio, "please put the small yesterday blue book on the table by the window");
  ASSERT_TRUE(more) << more.error().describe();
  ASSERT_EQ(more->words.size(), 13u);
  EXPECT_FALSE(more->words[4].said);
  EXPECT_EQ(more->words[4].confidence, 0);
  ASSERT_EQ(more->confidences.size(), more->script.phones.size());
  ASSERT_FALSE(more->warnings.empty());
  EXPECT_THAT(more->warnings[0], HasSubstr("'yesterday'"));
  EXPECT_THAT(more->warnings[0], HasSubstr("not said"));

  const auto less = align(audio, "please put the small blue book by the window");
  ASSERT_TRUE(less) << less.error().describe();
  ASSERT_EQ(less->inserted.size(), 1u);
  EXPECT_GE(less->inserted[0].phones.size(), 3u);
  EXPECT_NEAR(double(less->inserted[0].before), 6, 1);
}

TEST(AlignWords, OneBadTokenCostsItsWordOnly) {
  SKIP_WITHOUT_ALIGNER();
  const auto speech = speak_text("please put the small blue book on the table");
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm audio = resample(speech->audio, kAlignRate);
  for (const char* token : {"\xF0\x9F\x98\x80", "@#$", "\xE3\x81\x82", "xkcdqq"}) {
    const auto found =
        align(audio, std::string("please put the small ") + token + " blue book on the table");
    ASSERT_TRUE(found) << token << ": " << found.error().describe();
    for (const char* word : {"please", "small", "blue", "table"}) {
      EXPECT_TRUE(std::any_of(found->words.begin(), found->words.end(),
                              [&](const AlignedWord& one) { return one.text == word && one.said; }))
          << token << ", " << word;
    }
  }
}

TEST(AlignWords, KnowsATextThatIsNotSaid) {
  SKIP_WITHOUT_ALIGNER();
  const std::string text = "please put the small blue book on the table by the window";
  const auto speech = speak_text(text);
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm audio = resample(speech->audio, kAlignRate);
  const auto right = align(audio, text);
  ASSERT_TRUE(right) << right.error().describe();
  ASSERT_EQ(right->words.size(), 12u);
  EXPECT_EQ(right->words[5].text, "book");
  EXPECT_GT(right->words[5].end, right->words[5].start);
  const std::string other = "nine years ago our uncle never knew how many letters she wrote";
  const auto wrong = align(audio, other);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::out_of_range);
  const auto forced = align(audio, other, everything());
  ASSERT_TRUE(forced) << forced.error().describe();
  EXPECT_LT(forced->confidence, right->confidence);

  media::Pcm noise = silence(3);
  add_noise(noise, 0.1f);
  EXPECT_FALSE(align(noise, text));
  EXPECT_FALSE(align(silence(3), text));
}

std::vector<std::string> unsaid(const Alignment& found) {
  std::vector<std::string> words;
  for (const AlignedWord& word : found.words) {
    if (!word.said) words.push_back(word.text);
  }
  return words;
}

// Each is as short as can be when it is squeezed in, and nothing but it is told.
TEST(AlignWords, AShortWordTooManyIsNamed) {
  SKIP_WITHOUT_ALIGNER();
  const auto speech = speak_text("please put the small blue book on the table by the window");
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm audio = resample(speech->audio, kAlignRate);
  for (const char* word : {"lay", "five", "green", "j", "never"}) {
    const auto found = align(audio, std::string("please put the small ") + word +
                                        " blue book on the table by the window");
    ASSERT_TRUE(found) << word << ": " << found.error().describe();
    EXPECT_EQ(unsaid(*found), std::vector<std::string>{word});
  }
}

// A word that is taken out of the sound, not of the text.
TEST(AlignWords, AWordCutOutIsNamed) {
  SKIP_WITHOUT_ALIGNER();
  const std::string text = "please put the small blue book on the table by the window";
  const auto speech = speak_text(text);
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm whole = resample(speech->audio, kAlignRate);
  for (const char* word : {"small", "book", "table"}) {
    media::Pcm audio{kAlignRate, {}};
    for (std::size_t i = 0; i < whole.samples.size(); ++i) {
      const double time = double(i) / kAlignRate;
      const auto& phones = speech->script.phones;
      const bool cut = std::any_of(phones.begin(), phones.end(), [&](const dam::Phone& phone) {
        return phone.word == word && phone.start <= time && time < phone.end;
      });
      if (!cut) audio.samples.push_back(whole.samples[i]);
    }
    ASSERT_LT(audio.samples.size(), whole.samples.size());
    const auto found = align(audio, text);
    ASSERT_TRUE(found) << word << ": " << found.error().describe();
    EXPECT_EQ(unsaid(*found), std::vector<std::string>{word});
  }
}

TEST(AlignWords, OtherLanguagesAreTakenAndTheirWrongTextsRefused) {
  SKIP_WITHOUT_ALIGNER();
  const struct {
    const char *language, *text, *other;
  } kTrials[] = {
      {"it", "Domani mattina andiamo al mercato e compriamo pane, formaggio e vino rosso",
       "Il treno per Napoli parte dal secondo binario con dieci minuti di ritardo"},
      {"ru", "Завтра утром мы поедем на рынок и купим хлеб, сыр и красное вино",
       "Поезд отправляется со второго пути с опозданием на десять минут"}};
  for (const auto& trial : kTrials) {
    VoiceOptions voice;
    voice.language = trial.language;
    const auto speech = speak_text(trial.text, voice);
    SKIP_WITHOUT_VOICE(speech);
    const media::Pcm audio = resample(speech->audio, kAlignRate);
    AlignOptions options;
    options.language = trial.language;
    const auto right = align(audio, trial.text, options);
    ASSERT_TRUE(right) << trial.language << ": " << right.error().describe();
    EXPECT_TRUE(unsaid(*right).empty()) << trial.language;
    EXPECT_FALSE(align(audio, trial.other, options)) << trial.language;
  }
}

// More than a minute is placed in pieces; a word that nobody can say stands in the middle.
TEST(AlignWords, ABadTokenInALongRecordingCostsItsWordOnly) {
  SKIP_WITHOUT_ALIGNER();
  const std::string sentence = "please put the small blue book on the table by the window";
  const auto speech = speak_text(sentence);
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm one = resample(speech->audio, kAlignRate);
  media::Pcm audio{kAlignRate, {}};
  std::string text;
  std::size_t count = 0;
  for (; audio.duration() < 70; ++count) {
    audio.samples.insert(audio.samples.end(), one.samples.begin(), one.samples.end());
    audio.samples.resize(audio.samples.size() + kAlignRate / 4);
    text += (count == 10 ? "\xF0\x9F\x98\x80 @#$ " : "") + sentence + " ";
  }
  ASSERT_GT(count, 15u);
  const auto found = align(audio, text);
  ASSERT_TRUE(found) << found.error().describe();
  std::size_t far = 0, said = 0;
  for (const AlignedWord& word : found->words) {
    if (!word.known) continue;
    const double expected = double(said / 12) * (one.duration() + 0.25);
    far += !word.said || word.start < expected || word.end > expected + one.duration() + 0.25;
    ++said;
  }
  EXPECT_EQ(said, 12 * count);
  EXPECT_LE(far, 1u);
}

}  // namespace align_words_test
}  // namespace animeme::voice
