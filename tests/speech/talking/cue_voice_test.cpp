#include "tools/speech/talking/cue_voice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace animeme::speech {
namespace cue_voice_test {

constexpr int kRate = 22050;
constexpr double kLetter = 0.06, kComma = 0.25;  // seconds

// A voice that says "AA" for each letter and pauses at commas; its sound is 1 in letters.
Result<voice::Speech> say(const std::string& text, double speed) {
  voice::Speech speech;
  speech.audio.sample_rate = kRate;
  speech.voice = "test";
  const auto add = [&](const char* label, double seconds, float level) {
    const double start = speech.audio.duration();
    speech.audio.samples.resize(
        speech.audio.samples.size() + std::size_t(std::llround(seconds / speed * kRate)), level);
    speech.script.phones.push_back({start, speech.audio.duration(), label, {}});
  };
  for (const char c : text) {
    if (c == ' ') continue;
    c == ',' ? add("SIL", kComma, 0) : add("AA", kLetter, 1);
  }
  return speech;
}

SpeakAtSpeed speaker_of(const std::vector<Cue>& list) {
  return [list](std::size_t cue, double speed) { return say(list[cue].text, speed); };
}

std::vector<Cue> cues() {
  return {{0.5, 2.0, "abcdefghijklmnopqrstuvwxy"},       // 1.5 s: fits as it is
          {2.5, 4.0, "abcdefghij"},                      // 0.6 s: slower, but not below the range
          {4.5, 6.0, "abcdefghij, klmnopqrstuv, wxyz"},  // 1.56 s and 0.5 s of pauses
          {7.0, 8.0, "abcdefghijklmnopqrst"},            // 1.2 s: faster
          {8.5, 9.5, "abcdefghijklmnopqrstuvwxyzabcdefghijklmn"},  // 2.4 s: too long
          {9.6, 11.0, "abcdefgh"}};
}

TEST(CueVoice, EachInItsTimeOrTold) {
  const auto fitted = fit_cues(cues(), speaker_of(cues()));
  ASSERT_TRUE(fitted) << fitted.error().describe();
  const auto& list = fitted->cues;
  ASSERT_EQ(list.size(), 6u);
  EXPECT_DOUBLE_EQ(list[0].speed, 1);
  EXPECT_NEAR(list[0].seconds, 1.5, 0.02);
  EXPECT_NEAR(list[1].speed, 0.8, 1e-9);
  EXPECT_NEAR(list[1].seconds, 0.75, 0.01);
  // Pauses first; 0.38 s of them can go, then a little speed is needed.
  EXPECT_NEAR(list[2].shortened, 0.37, 0.05);
  EXPECT_GT(list[2].speed, 1);
  EXPECT_LT(list[2].speed, 1.15);
  EXPECT_NEAR(list[2].seconds, 1.5, 0.03);
  EXPECT_NEAR(list[3].speed, 1.2, 0.02);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(list[i].cut, 0u) << i;
    EXPECT_EQ(list[i].late, 0) << i;
    EXPECT_DOUBLE_EQ(list[i].start, list[i].cue.start) << i;
  }
  // Nothing is cut off: it is told, and the next one waits.
  EXPECT_NEAR(list[4].speed, 1.3, 1e-9);
  EXPECT_NEAR(list[4].seconds, 2.4 / 1.3, 0.02);
  EXPECT_GE(list[4].cut, 17u);
  EXPECT_LE(list[4].cut, 20u);
  EXPECT_NEAR(list[4].late, 2.4 / 1.3 - 1, 0.02);
  EXPECT_NEAR(list[5].start, 8.5 + 2.4 / 1.3 + 0.04, 0.02);
  EXPECT_EQ(list[5].late, 0);
}

TEST(CueVoice, SoundAndScriptAreOne) {
  const auto fitted = fit_cues(cues(), speaker_of(cues()));
  ASSERT_TRUE(fitted);
  const voice::Speech& speech = fitted->speech;
  EXPECT_TRUE(dam::check_script(speech.script)) << dam::check_script(speech.script).error().message;
  EXPECT_NEAR(speech.script.duration(), speech.audio.duration(), 0.001);
  // Each letter is heard where the script has it, silence elsewhere.
  std::size_t letters = 0, wrong = 0;
  for (const dam::Phone& phone : speech.script.phones) {
    const bool letter = phone.label == "AA";
    letters += letter ? 1 : 0;
    const auto first = std::size_t(std::llround(phone.start * kRate));
    const auto last = std::size_t(std::llround(phone.end * kRate));
    for (std::size_t i = first + 2; i + 2 < last; ++i)
      wrong += (speech.audio.samples[i] != 0) == letter ? 0 : 1;
  }
  std::size_t said = 0;
  for (const Cue& cue : cues())
    for (const char c : cue.text) said += c >= 'a' && c <= 'z' ? 1 : 0;
  EXPECT_EQ(letters, said);
  EXPECT_EQ(wrong, 0u);
}

// One that speaks in steps of a fifth of its speed: what is missing is stretched.
TEST(CueVoice, AVoiceOfFewSpeeds) {
  const auto fitted =
      fit_cues({{0, 1.4, "abcdefghijklmnopqrstuvwxyz"}}, [](std::size_t, double speed) {
        return say("abcdefghijklmnopqrstuvwxyz", 1 + 0.2 * std::floor((speed - 1) / 0.2 + 1e-9));
      });
  ASSERT_TRUE(fitted) << fitted.error().describe();
  EXPECT_EQ(fitted->cues[0].cut, 0u);
  EXPECT_NEAR(fitted->cues[0].speed, 1.56 / 1.4, 0.02);
  EXPECT_NEAR(fitted->cues[0].seconds, 1.4, 0.02);
  EXPECT_TRUE(dam::check_script(fitted->speech.script));
}

TEST(CueVoice, AVoiceOfOneSpeed) {
  const auto fitted =
      fit_cues({{0, 1, "abcdefghijklmnopqrstuvwxyz, abc"}},
               [](std::size_t, double) { return say("abcdefghijklmnopqrstuvwxyz, abc", 1); });
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->cues[0].speed, 1.3, 1e-9);  // stretched
  EXPECT_NEAR(fitted->cues[0].seconds, (29 * kLetter + 0.06) / 1.3, 0.01);
  EXPECT_NEAR(fitted->cues[0].shortened, 0.19 / 1.3, 0.01);
  EXPECT_GE(fitted->cues[0].cut, 8u);
}

TEST(CueVoice, Mistakes) {
  const auto none = [](std::size_t, double) { return say("a", 1); };
  EXPECT_EQ(fit_cues({}, none).error().code, Code::invalid_argument);
  EXPECT_EQ(fit_cues({{1, 1, "a"}}, none).error().code, Code::invalid_argument);
  EXPECT_EQ(fit_cues({{3, 4, "a"}, {1, 2, "b"}}, none).error().code, Code::invalid_argument);
  EXPECT_EQ(fit_cues({{3, 4, "a"}}, none, {0.2, 1}).error().code, Code::invalid_argument);
  EXPECT_EQ(fit_cues({{1e6, 1e6 + 1, "a"}}, none).error().code, Code::out_of_range);
  const auto failed = fit_cues({{0, 1, "a"}, {2, 3, "b"}}, [](std::size_t cue, double speed) {
    if (cue == 1) return Result<voice::Speech>(make_error(Code::not_found, "no such voice"));
    return say("a", speed);
  });
  EXPECT_EQ(failed.error().message, "subtitle 2: no such voice");
  EXPECT_EQ(parse_fit_range("0.8-1.3").value(), FitRange());
  for (const char* wrong : {"", "1", "0.8", "1.3-0.8", "0.1-1", "0.8-3", "0.8-1.3x", "a-b"})
    EXPECT_EQ(parse_fit_range(wrong).error().code, Code::invalid_argument) << wrong;
}

// A recording in which the letters of each cue are said one after the other from `starts` on.
struct Recording {
  media::Pcm audio;
  dam::Script script;
  std::vector<RecordedCue> said;
};

Recording recording_of(const std::vector<Cue>& list, const std::vector<double>& starts) {
  Recording all;
  all.audio.sample_rate = kRate;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto one = say(list[i].text, 1);
    const auto first = std::size_t(std::llround(starts[i] * kRate));
    all.script.phones.push_back({all.audio.duration(), starts[i], "SIL", {}});
    all.audio.samples.resize(first);
    all.audio.samples.insert(all.audio.samples.end(), one->audio.samples.begin(),
                             one->audio.samples.end());
    for (dam::Phone phone : one->script.phones) {
      phone.start += starts[i];
      phone.end += starts[i];
      all.script.phones.push_back(phone);
    }
    all.said.push_back({starts[i], all.audio.duration(), 0.9});
  }
  return all;
}

TEST(CueVoice, ARecordingInItsTimeStaysAsItIs) {
  const std::vector<Cue> list = {{0.5, 2.0, "abcdefghij"}, {2.5, 4.0, "abcdefghij, klmno"}};
  const Recording one = recording_of(list, {0.6, 2.4});
  const auto fitted = fit_recording(list, one.said, one.audio, one.script);
  ASSERT_TRUE(fitted) << fitted.error().describe();
  EXPECT_FALSE(fitted->speech);
  ASSERT_EQ(fitted->cues.size(), 2u);
  EXPECT_NEAR(fitted->cues[1].start, 2.4, 1e-3);
  EXPECT_NEAR(fitted->cues[1].seconds, 1.15, 1e-3);
  EXPECT_DOUBLE_EQ(fitted->cues[1].speed, 1);
  EXPECT_EQ(fitted->cues[1].confidence, 0.9);
}

TEST(CueVoice, ARecordingElsewhereIsPutIntoItsTimes) {
  const std::vector<Cue> list = {{1, 2, "abcdefghij"},                       // 0.6 s
                                 {2.5, 4, "abcdefghijklmnop, qrstuvwxyz"},   // 1.56 + 0.25 s
                                 {5, 6, "abcdefghijklmnopqrst"},             // 1.2 s
                                 {7, 8, "abcdefghijklmnopqrstuvwxyzabcd"}};  // 1.8 s
  const Recording one = recording_of(list, {0.1, 1, 3.2, 4.6});
  const auto fitted = fit_recording(list, one.said, one.audio, one.script);
  ASSERT_TRUE(fitted) << fitted.error().describe();
  ASSERT_TRUE(fitted->speech);
  const auto& cues = fitted->cues;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(cues[i].start, list[i].start, 1e-9) << i;
    EXPECT_LE(cues[i].start + cues[i].seconds, list[i].end + 0.03) << i;
    EXPECT_EQ(cues[i].cut, 0u) << i;
  }
  EXPECT_DOUBLE_EQ(cues[0].speed, 1);  // not slowed down
  EXPECT_NEAR(cues[1].shortened, 0.19, 0.02);
  EXPECT_NEAR(cues[1].speed, 1.08, 0.05);
  EXPECT_NEAR(cues[2].speed, 1.2, 0.02);
  EXPECT_NEAR(cues[3].speed, 1.3, 1e-9);
  EXPECT_NEAR(double(cues[3].cut), 9, 2);
  EXPECT_NEAR(cues[3].late, 1.8 / 1.3 - 1, 0.02);
  const voice::Speech& speech = *fitted->speech;
  EXPECT_TRUE(dam::check_script(speech.script));
  EXPECT_NEAR(speech.script.duration(), speech.audio.duration(), 0.002);
  // Silence where the script has it, and nothing of the recording is lost.
  std::size_t letters = 0;
  for (const dam::Phone& phone : speech.script.phones) {
    letters += phone.label == "AA" ? 1 : 0;
    const auto middle = std::size_t((phone.start + phone.end) / 2 * kRate);
    EXPECT_EQ(speech.audio.samples[middle] != 0, phone.label == "AA") << phone.start;
  }
  EXPECT_EQ(letters, 10u + 26 + 20 + 30);
  EXPECT_EQ(fit_recording(list, {}, one.audio, one.script).error().code, Code::invalid_argument);
}

TEST(CueVoice, WordsOfARecordingBelongToTheirCues) {
  const std::vector<std::string> texts = {"The map, the map!", "The end.", "Not said."};
  const std::vector<voice::AlignedWord> words = {{"The", 0.1, 0.2, 0.5}, {"map", 0.2, 0.5, 0.7},
                                                 {"the", 0.8, 0.9, 0.9}, {"map", 0.9, 1.2, 0.9},
                                                 {"The", 2, 2.1, 1},     {"end", 2.1, 2.4, 0.5},
                                                 {"Not", 3, 3, 0, false}};
  const auto found = find_cues(texts, words);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_DOUBLE_EQ(found[0].start, 0.1);
  EXPECT_DOUBLE_EQ(found[0].end, 1.2);
  EXPECT_NEAR(found[0].confidence.value(), 0.75, 1e-9);
  EXPECT_DOUBLE_EQ(found[1].start, 2);
  EXPECT_NEAR(found[1].confidence.value(), 0.75, 1e-9);
  EXPECT_EQ(found[2].end, found[2].start);
  EXPECT_FALSE(found[2].confidence);
}

TEST(CueVoice, ReadsSubtitles) {
  const auto timings = dam::read_timings(
      "1\n00:00:00,500 --> 00:00:02,000\nGuten Morgen,\nliebe Freunde!\n\n"
      "2\n00:00:02,500 --> 00:00:04,000\n<i>Wie geht es?</i>\n");
  ASSERT_TRUE(timings) << timings.error().describe();
  const auto cues = cues_of(*timings);
  ASSERT_TRUE(cues) << cues.error().describe();
  ASSERT_EQ(cues->size(), 2u);
  EXPECT_EQ((*cues)[0].text, "Guten Morgen, liebe Freunde!");
  EXPECT_NEAR((*cues)[0].start, 0.5, 1e-9);
  EXPECT_NEAR((*cues)[0].end, 2, 1e-9);
  EXPECT_EQ((*cues)[1].text, "Wie geht es?");
  const auto phones = dam::read_timings("start_s\tend_s\tphone\n0\t1\tAA\n");
  ASSERT_TRUE(phones);
  EXPECT_EQ(cues_of(*phones).error().code, Code::unsupported);
}

}  // namespace cue_voice_test
}  // namespace animeme::speech
