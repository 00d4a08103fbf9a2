#include "tools/speech/voice/align.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "tests/speech/voice/align_support.h"
#include "tests/support/shared.h"

namespace animeme::voice {
namespace align_test {

using namespace align_support;  // NOLINT: as if they were here
using testing::HasSubstr;

// Distances in ms between the starts of phones that both scripts have, in order.
std::vector<double> start_errors(const dam::Script& expected, const dam::Script& found) {
  std::vector<double> errors;
  std::size_t from = 0;
  for (const dam::Phone& phone : expected.phones) {
    if (phone.label == dam::kSilence) continue;
    // A voice names words with their punctuation. Labels without words have the same phone near.
    const bool words = !phone.word.empty();
    const std::size_t last = words ? found.phones.size() : std::min(from + 6, found.phones.size());
    for (std::size_t i = from; i < last; ++i) {
      const bool same_word = !words || phone.word.starts_with(found.phones[i].word);
      if (found.phones[i].label != phone.label || !same_word) continue;
      errors.push_back(1000 * std::abs(found.phones[i].start - phone.start));
      from = i + 1;
      break;
    }
  }
  return errors;
}

double percentile(std::vector<double> values, std::size_t percent) {
  std::sort(values.begin(), values.end());
  return values[values.size() * percent / 100];
}

double median(const std::vector<double>& values) { return percentile(values, 50); }

void print(const std::vector<double>& errors) {
  std::cout << "starts: " << errors.size() << ", median " << median(errors) << " ms, 90 % within "
            << percentile(errors, 90) << " ms\n";
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// 16 kHz mono s16 with a header of 44 bytes, as the corpus has it.
media::Pcm read_plain_wav(const std::filesystem::path& path) {
  const std::string bytes = file_text(path);
  media::Pcm audio{kAlignRate, {}};
  for (std::size_t at = 44; at + 1 < bytes.size(); at += 2) {
    std::int16_t sample = 0;
    std::memcpy(&sample, bytes.data() + at, 2);
    audio.samples.push_back(float(sample) / 32768.0f);
  }
  return audio;
}

TEST(Align, ASyntheticVoiceAgainstItsOwnScript) {
  SKIP_WITHOUT_ALIGNER();
  const std::string text = "please put the small blue book on the table by the window";
  const auto speech = speak_text(text);
  SKIP_WITHOUT_VOICE(speech);
  const auto aligned = align(resample(speech->audio, kAlignRate), text);
  ASSERT_TRUE(aligned) << aligned.error().describe();
  EXPECT_FALSE(aligned->approximate);
  EXPECT_TRUE(aligned->warnings.empty());
  const auto good = dam::check_script(aligned->script);
  EXPECT_TRUE(good) << good.error().describe();
  EXPECT_NEAR(aligned->script.duration(), speech->audio.duration(), 1e-3);
  const auto errors = start_errors(speech->script, aligned->script);
  ASSERT_GE(errors.size(), 25u);
  print(errors);
  EXPECT_LT(median(errors), 60);
}

struct Aligned {
  std::vector<double> errors;  // ms
  double confidence = 0;       // the mean
};

// The first `count` sentences of a corpus that have sound, behind so many zeros, compared with
// their labels.
void align_corpus(const std::filesystem::path& corpus, int count, Aligned& all,
                  std::size_t zeros = 0) {
  std::istringstream table(file_text(corpus / "utterances.tsv"));
  std::string line;
  std::getline(table, line);
  int done = 0;
  while (done < count && std::getline(table, line)) {
    const std::string id = line.substr(0, line.find('\t'));
    const std::string text =
        line.substr(id.size() + 1, line.find('\t', id.size() + 1) - id.size() - 1);
    if (!std::filesystem::exists(corpus / "audio" / (id + ".wav"))) continue;
    media::Pcm sound = read_plain_wav(corpus / "audio" / (id + ".wav"));
    sound.samples.insert(sound.samples.begin(), zeros, 0.0f);
    auto aligned = align(sound, text);
    ASSERT_TRUE(aligned) << id << ": " << aligned.error().describe();
    EXPECT_FALSE(aligned->approximate) << id;
    const auto labels = dam::read_script(file_text(corpus / "phonemes" / (id + ".tsv")));
    ASSERT_TRUE(labels);
    for (dam::Phone& phone : aligned->script.phones) phone.start -= double(zeros) / kAlignRate;
    const auto some = start_errors(*labels, aligned->script);
    all.errors.insert(all.errors.end(), some.begin(), some.end());
    all.confidence += aligned->confidence;
    ++done;
  }
  all.confidence /= std::max(done, 1);
}

// ANIMEME_ALIGN_UTTERANCES sets how many are aligned.
TEST(Align, GridUtterancesAgainstTheirLabels) {
  SKIP_WITHOUT_ALIGNER();
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  const char* wanted = std::getenv("ANIMEME_ALIGN_UTTERANCES");
  Aligned all;
  align_corpus(shared / "data" / "grid_s1", wanted != nullptr ? std::atoi(wanted) : 10, all);
  const std::vector<double>& errors = all.errors;
  ASSERT_GE(errors.size(), 140u);
  print(errors);
  EXPECT_LT(median(errors), 35);
}

// Clean speech of nine other people: a mean of speech without pauses costs 7 ms and 0.05. Labels
// lie on a grid of 10 ms, which other frames cannot reproduce.
TEST(Align, CleanSpeechOfStrangersIsSure) {
  SKIP_WITHOUT_ALIGNER();
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  for (const std::size_t zeros : {0, 1600, 54321}) {
    Aligned all;
    align_corpus(shared / "data" / "grid_others", 10, all, zeros);
    ASSERT_GE(all.errors.size(), 100u);
    print(all.errors);
    const bool same_frames = zeros % 160 == 0;
    EXPECT_LT(median(all.errors), same_frames ? 10 : 15) << zeros;
    EXPECT_GT(all.confidence, same_frames ? 0.97 : 0.94) << zeros;
  }
}

TEST(Align, WordsOutsideTheDictionaryAndOtherLanguages) {
  SKIP_WITHOUT_ALIGNER();
  VoiceOptions german;
  german.language = "de";
  const auto speech = speak_text("Guten Morgen, liebe Kinder", german);
  SKIP_WITHOUT_VOICE(speech);
  AlignOptions options;
  options.language = "de";
  const auto aligned =
      align(resample(speech->audio, kAlignRate), "Guten Morgen, liebe Kinder", options);
  ASSERT_TRUE(aligned) << aligned.error().describe();
  EXPECT_FALSE(aligned->approximate);
  const auto errors = start_errors(speech->script, aligned->script);
  ASSERT_GE(errors.size(), 12u);
  EXPECT_LT(median(errors), 60);

  const auto invented = speak_text("the zorblax is red");
  ASSERT_TRUE(invented);
  const auto english = align(resample(invented->audio, kAlignRate), "the zorblax is red");
  ASSERT_TRUE(english) << english.error().describe();
  EXPECT_TRUE(std::any_of(english->script.phones.begin(), english->script.phones.end(),
                          [](const dam::Phone& phone) { return phone.word == "zorblax"; }));
}

TEST(Align, SameInputSameScript) {
  SKIP_WITHOUT_ALIGNER();
  const auto speech = speak_text("seven green apples");
  SKIP_WITHOUT_VOICE(speech);
  const media::Pcm audio = resample(speech->audio, kAlignRate);
  const auto first = align(audio, "seven green apples");
  const auto second = align(audio, "seven green apples");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->script, second->script);
}

TEST(Align, PrintsNothing) {
  SKIP_WITHOUT_ALIGNER();
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto aligned = align(silence(2), "some words", everything());
  EXPECT_TRUE(testing::internal::GetCapturedStderr().empty());
  EXPECT_TRUE(testing::internal::GetCapturedStdout().empty());
  ASSERT_TRUE(aligned) << aligned.error().describe();
}

// Far more text than fits: the recogniser finds no path, and the result says so.
TEST(Align, FallsBackToUsualDurations) {
  SKIP_WITHOUT_ALIGNER();
  media::Pcm audio = silence(1.0);
  for (std::size_t i = 4800; i < 11200; ++i) {
    audio.samples[i] = 0.3f * std::sin(0.05f * float(i));
  }
  const std::string text = "nobody can say this long sentence in a second, not even you";
  EXPECT_EQ(align(audio, text).error().code, Code::out_of_range);
  const auto aligned = align(audio, text, everything());
  ASSERT_TRUE(aligned) << aligned.error().describe();
  EXPECT_TRUE(aligned->approximate);
  ASSERT_EQ(aligned->warnings.size(), 1u);
  EXPECT_THAT(aligned->warnings[0], HasSubstr("check that the text"));
  const dam::Script& script = aligned->script;
  EXPECT_TRUE(dam::check_script(script));
  EXPECT_EQ(script.phones.front().label, "SIL");
  EXPECT_NEAR(script.phones.front().end, 0.3, 0.03);
  EXPECT_NEAR(script.phones.back().start, 0.7, 0.03);
  EXPECT_EQ(script.duration(), 1.0);
}

TEST(Align, ARoomMovesNothingFar) {
  SKIP_WITHOUT_ALIGNER();
  const std::string text = "please put the small blue book on the table by the window";
  const auto speech = speak_text(text);
  SKIP_WITHOUT_VOICE(speech);
  media::Pcm audio = resample(speech->audio, kAlignRate);
  add_noise(audio, 0.05f);
  const auto aligned = align(audio, text);
  ASSERT_TRUE(aligned) << aligned.error().describe();
  const auto errors = start_errors(speech->script, aligned->script);
  ASSERT_GE(errors.size(), 25u);
  print(errors);
  EXPECT_LT(median(errors), 40);
}

TEST(Align, RefusesWithAReason) {
  EXPECT_THAT(align(silence(1, 22050), "yes").error().message, HasSubstr("16000 Hz"));
  EXPECT_EQ(align(silence(1, 0), "yes").error().code, Code::invalid_argument);
  EXPECT_EQ(align(silence(0.05), "yes").error().code, Code::truncated);
  EXPECT_EQ(align(silence(1), std::string(kMostTranscript + 1, 'a')).error().code,
            Code::out_of_range);
  EXPECT_EQ(align(silence(1), " ... ").error().code, Code::invalid_argument);
  SKIP_WITHOUT_ALIGNER();
  AlignOptions options;
  options.dictionary_path = "/nowhere";
  const auto no_dictionary = align(silence(1), "yes", options);
  ASSERT_FALSE(no_dictionary);
  EXPECT_EQ(no_dictionary.error().code, Code::not_found);
  EXPECT_THAT(no_dictionary.error().message, HasSubstr("pocketsphinx-en-us"));
  options = {};
  options.model_path = "/nowhere";
  EXPECT_EQ(align(silence(1), "yes", options).error().code, Code::not_found);
  EXPECT_EQ(align(silence(0.15), "a hundred thousand millions").error().code, Code::out_of_range);
}

TEST(Align, HostileSamples) {
  SKIP_WITHOUT_ALIGNER();
  media::Pcm audio = silence(1.0);
  for (std::size_t i = 0; i < audio.samples.size(); ++i) {
    const float wild[] = {std::nanf(""), INFINITY, -INFINITY, 1e30f, -5.0f};
    audio.samples[i] = wild[i % 5];
  }
  const auto aligned = align(audio, "yes", everything());
  ASSERT_TRUE(aligned) << aligned.error().describe();
  EXPECT_TRUE(dam::check_script(aligned->script));
}

}  // namespace align_test
}  // namespace animeme::voice
