// The other party of a conversation: where it speaks is found in its sound, and the head nods
// there.
#include "tools/speech/talking/other_voice.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/temp_dir.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {
namespace other_voice_test {

constexpr int kRate = 16000;

/// Samples that come `bunch` at a time, or all at once; not before the time of their last one.
class GivenSound : public SoundFeed {
 public:
  explicit GivenSound(std::vector<float> samples) : samples_(std::move(samples)) {}
  std::vector<float> take(std::size_t most) override {
    const std::size_t count = std::min(most, samples_.size() - at_);
    at_ += count;
    const auto end = samples_.begin() + std::ptrdiff_t(at_);
    return {end - std::ptrdiff_t(count), end};
  }
  bool over() override { return at_ == samples_.size(); }

 private:
  std::vector<float> samples_;
  std::size_t at_ = 0;
};

/// A part of a conversation, seconds.
struct Part {
  double start, end;
};

/// Two sentences of a voice, with a second before, between and behind them.
struct Talk {
  std::vector<float> samples;
  std::vector<Part> sentences;
};

Talk talk(double gain, double noise) {
  Talk all;
  std::minstd_rand random(3);
  std::normal_distribution<float> hiss(0, 1);  // a deviation of 0 is not allowed
  const auto silence = [&] { all.samples.insert(all.samples.end(), kRate, 0.0f); };
  silence();
  for (const char* text : {"I have been thinking about our trip to Norway all day long.",
                           "Where would you like to go on Monday, my friend?"}) {
    voice::VoiceOptions options;
    const auto speech = voice::speak_text(text, options);
    if (!speech) return {};
    const auto sound = media::resample(speech->audio, kRate);
    if (!sound) return {};
    double start = 1e9, end = 0;
    for (std::size_t i = 0; i < sound->samples.size(); ++i) {
      if (std::abs(sound->samples[i]) < 0.02f) continue;
      const double time = double(i + all.samples.size()) / kRate;
      start = std::min(start, time);
      end = time;
    }
    all.sentences.push_back({start, end});
    all.samples.insert(all.samples.end(), sound->samples.begin(), sound->samples.end());
    silence();
  }
  for (float& sample : all.samples) sample = float(gain) * sample + float(noise) * hiss(random);
  return all;
}

/// Changes of what is heard, in blocks of `seconds`.
std::vector<Part> heard(const std::vector<float>& samples, double seconds) {
  VoiceActivity activity(kRate);
  std::vector<Part> parts;
  const auto block = std::size_t(seconds * kRate);
  bool before = false;
  for (std::size_t at = 0; at < samples.size(); at += block) {
    const std::size_t count = std::min(block, samples.size() - at);
    activity.push(std::span(samples).subspan(at, count));
    const double time = double(at + count) / kRate;
    if (activity.speaking() && !before) parts.push_back({time, time});
    if (!activity.speaking() && before) parts.back().end = time;
    before = activity.speaking();
  }
  return parts;
}

TEST(VoiceActivity, FindsSentencesAtAnyLevelAndInNoise) {
  for (const auto& [gain, noise] :
       {std::pair{1.0, 0.0}, std::pair{1.0, 0.003}, std::pair{0.05, 0.0}, std::pair{0.3, 0.005}}) {
    const Talk said = talk(gain, noise);
    if (said.samples.empty()) GTEST_SKIP() << "no voice";
    const auto parts = heard(said.samples, 0.01);
    double inside = 0, outside = 0, length = 0;
    for (const Part& sentence : said.sentences) length += sentence.end - sentence.start;
    for (const Part& part : parts) {
      double overlap = 0;
      // What is heard ends 0.2 s after the sound.
      for (const Part& sentence : said.sentences)
        overlap += std::max(0.0, std::min(part.end, sentence.end + 0.35) -
                                     std::max(part.start, sentence.start - 0.05));
      inside += overlap;
      outside += part.end - part.start - overlap;
    }
    EXPECT_GT(inside, 0.85 * length) << gain << ' ' << noise;
    EXPECT_LT(outside, 0.1) << gain << ' ' << noise;
  }
}

TEST(VoiceActivity, SteadyNoiseIsNoSpeech) {
  for (const double size : {0.0, 0.0005, 0.005, 0.05, 0.3}) {
    std::minstd_rand random(11);
    std::normal_distribution<float> hiss(0, 1);
    std::vector<float> samples(std::size_t(30) * kRate);
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] =
          size > 0 ? float(size) * hiss(random) : 0.2f * float(std::sin(0.0196 * double(i)));
    for (const Part& part : heard(samples, 0.01)) EXPECT_LT(part.end, 20) << size;
    EXPECT_LE(heard(samples, 0.01).size(), 1u) << size << ", 0 is a hum of 50 Hz";
  }
}

TEST(VoiceActivity, ClicksAndStrangeValuesAreNoSpeech) {
  std::vector<float> samples(std::size_t(10) * kRate, 0.0f);
  for (std::size_t i = kRate; i < samples.size(); i += kRate) samples[i] = 1;
  samples[5] = std::nanf("");
  samples[6] = INFINITY;
  EXPECT_TRUE(heard(samples, 0.01).empty());
}

TEST(VoiceActivity, TheSizeOfThePiecesDoesNotMatter) {
  const Talk said = talk(1, 0.001);
  if (said.samples.empty()) GTEST_SKIP() << "no voice";
  const auto fine = heard(said.samples, 0.01), coarse = heard(said.samples, 0.04);
  ASSERT_EQ(fine.size(), coarse.size());
  for (std::size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(fine[i].start, coarse[i].start, 0.041);
}

TEST(OtherVoice, AFileIsHeardInItsOwnTime) {
  const Talk said = talk(1, 0);
  if (said.samples.empty()) GTEST_SKIP() << "no voice";
  OtherVoice other(std::make_unique<GivenSound>(said.samples), kRate, false);
  const Part first = said.sentences.front();
  for (double time = 0; time < 30; time += 0.04) {
    const bool speaks = other.at(100 + time);
    if (time < first.start) {
      EXPECT_FALSE(speaks) << time;
    }
    if (time > first.start + 0.2 && time < first.start + 0.6) {
      EXPECT_TRUE(speaks) << time;
    }
    if (time > said.sentences.back().end + 0.5) {
      EXPECT_FALSE(speaks) << time;
    }
  }
}

TEST(OtherVoice, AVoiceThatStopsComingPauses) {
  // In the middle of a sentence.
  Talk said = talk(1, 0);
  if (said.samples.empty()) GTEST_SKIP() << "no voice";
  const double middle = said.sentences.front().start + 0.7;
  said.samples.resize(std::size_t(middle * kRate));
  OtherVoice other(std::make_unique<GivenSound>(said.samples), kRate, false);
  bool spoke = false;
  double time = 0;
  for (; time < middle; time += 0.04) spoke = other.at(time);
  EXPECT_TRUE(spoke);
  for (; time < middle + 0.6; time += 0.04) spoke = other.at(time);
  EXPECT_FALSE(spoke);
}

TEST(OtherVoice, OpensFilesAndPipes) {
  const test::TempDir dir;
  EXPECT_EQ(OtherVoice::open(dir / "none", std::nullopt).error().code, Code::not_found);
  EXPECT_EQ(OtherVoice::open(dir.path().string(), std::nullopt).error().code, Code::io);
  // A named pipe without a writer: nothing waits.
  const std::string pipe = dir / "mic";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto waiting = OtherVoice::open(pipe, BareSound{kRate, 1});
  ASSERT_TRUE(waiting) << waiting.error().describe();
  for (double time = 0; time < 1; time += 0.04) EXPECT_FALSE((*waiting)->at(time));
  // A file that is no WAV is told once.
  const std::string text = dir / "text";
  std::ofstream(text) << std::string(100, 'x');
  auto wrong = OtherVoice::open(text, std::nullopt);
  ASSERT_TRUE(wrong);
  std::optional<Error> error;
  for (int i = 0; i < 500 && !error; ++i) {
    EXPECT_FALSE((*wrong)->at(0.04 * i));
    error = (*wrong)->take_error();
    if (!error) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(error);
  EXPECT_FALSE((*wrong)->take_error());
}

}  // namespace other_voice_test
}  // namespace animeme::speech
