// Silence and noise before and behind the speech, and the level of a recording, change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/speech/voice/align_support.h"
#include "tools/speech/voice/listen.h"
#include "tools/speech/voice/speech_part.h"

namespace animeme::voice {
namespace padded_test {

using namespace align_support;  // NOLINT: as if they were here

constexpr double kSame = 0.020;  // seconds

struct Padding {
  double before, behind;  // times the length of the recording
  float noise;            // amplitude of white noise in it; 0: zeros
};

constexpr Padding kPaddings[] = {{0, 1, 0},      {1, 0, 0},         {3.3, 0.7, 0},
                                 {0, 10, 0},     {10, 0, 0},        {0, 1, 0.0005f},
                                 {2, 2, 0.001f}, {0.4, 9, 0.0008f}, {10, 0, 0.001f}};

media::Pcm padded(const media::Pcm& sound, const Padding& padding, double& lead) {
  const auto size = double(sound.samples.size());
  const auto before = std::size_t(padding.before * size);
  media::Pcm out = silence(0);
  out.samples.resize(before + sound.samples.size() + std::size_t(padding.behind * size));
  if (padding.noise > 0) add_noise(out, padding.noise);
  std::copy(sound.samples.begin(), sound.samples.end(),
            out.samples.begin() + std::ptrdiff_t(before));
  lead = double(before) / kAlignRate;
  return out;
}

// A voice in a room: noise of -60 dB.
media::Pcm recording(const std::string& text, const char* language = "en") {
  VoiceOptions options;
  options.language = language;
  const auto speech = speak_text(text, options);
  if (!speech) return silence(0);
  media::Pcm audio = resample(speech->audio, kAlignRate);
  add_noise(audio, 0.001f);
  return audio;
}

constexpr const char* kTexts[] = {"the boat was paid for by a bank in March",
                                  "my uncle keeps five white pigeons on the roof"};

TEST(Padded, WordsStayWhereTheyAre) {
  SKIP_WITHOUT_ALIGNER();
  for (const char* text : kTexts) {
    const media::Pcm sound = recording(text);
    if (sound.samples.empty()) GTEST_SKIP() << "no espeak-ng";
    const auto plain = align(sound, text);
    ASSERT_TRUE(plain) << plain.error().describe();
    for (const Padding& padding : kPaddings) {
      double lead = 0;
      const auto found = align(padded(sound, padding, lead), text);
      ASSERT_TRUE(found) << padding.before << " " << padding.behind << ": "
                         << found.error().describe();
      EXPECT_NEAR(found->confidence, plain->confidence, 0.05) << padding.before;
      EXPECT_TRUE(dam::check_script(found->script));
      ASSERT_EQ(found->words.size(), plain->words.size());
      for (std::size_t i = 0; i < found->words.size(); ++i) {
        EXPECT_NEAR(found->words[i].start - lead, plain->words[i].start, kSame)
            << plain->words[i].text;
        EXPECT_NEAR(found->words[i].end - lead, plain->words[i].end, kSame) << plain->words[i].text;
      }
    }
  }
}

TEST(Padded, ZerosChangeNothingThatIsHeard) {
  SKIP_WITHOUT_ALIGNER();
  const media::Pcm sound = recording(kTexts[0]);
  if (sound.samples.empty()) GTEST_SKIP() << "no espeak-ng";
  ListenOptions options;
  options.words = false;
  const auto plain = listen(sound, options);
  ASSERT_TRUE(plain);
  for (const Padding& padding : kPaddings) {
    double lead = 0;
    const media::Pcm longer = padded(sound, padding, lead);
    const auto heard = listen(longer, options);
    ASSERT_TRUE(heard);
    EXPECT_TRUE(dam::check_script(heard->script));
    EXPECT_NEAR(heard->script.duration(), longer.duration(), 1e-9);
    EXPECT_NEAR(heard->confidence, plain->confidence, 0.05) << padding.before;
    if (padding.noise > 0) continue;  // noise around a voice is no longer the same sound
    std::vector<dam::Phone> phones, others;
    for (const dam::Phone& one : plain->script.phones) {
      if (one.label != dam::kSilence) phones.push_back(one);
    }
    for (const dam::Phone& one : heard->script.phones) {
      if (one.label != dam::kSilence) others.push_back(one);
    }
    ASSERT_EQ(phones.size(), others.size());
    for (std::size_t i = 0; i < phones.size(); ++i) {
      EXPECT_EQ(others[i].label, phones[i].label);
      EXPECT_NEAR(others[i].start - lead, phones[i].start, kSame);
    }
  }
}

TEST(Padded, AQuietRecordingIsHeardAsALoudOne) {
  SKIP_WITHOUT_ALIGNER();
  const media::Pcm sound = recording(kTexts[1]);
  if (sound.samples.empty()) GTEST_SKIP() << "no espeak-ng";
  const auto plain = align(sound, kTexts[1]);
  ASSERT_TRUE(plain);
  for (const float gain : {3.0f, 0.1f, 0.003f}) {
    media::Pcm other = sound;
    for (float& one : other.samples) one = float(std::lround(gain * one * 32768)) / 32768;
    const auto found = align(other, kTexts[1]);
    ASSERT_TRUE(found) << gain << ": " << found.error().describe();
    EXPECT_NEAR(found->confidence, plain->confidence, 0.1) << gain;
    for (std::size_t i = 0; i < found->words.size(); ++i) {
      EXPECT_NEAR(found->words[i].start, plain->words[i].start, 0.03) << plain->words[i].text;
    }
  }
}

TEST(SpeechPart, OfSoundWithoutSpeechIsAllOfIt) {
  for (const std::size_t size : {0, 1, 159, 160, 5000, 32000}) {
    std::vector<float> samples(size);
    EXPECT_EQ(find_speech(samples).samples.size(), size);
    media::Pcm noise{kAlignRate, samples};
    add_noise(noise, 0.1f);
    const SpeechPart part = find_speech(noise.samples);
    EXPECT_EQ(part.first + part.samples.size(), size);
    EXPECT_EQ(part.speech.size(), (part.samples.size() + kSpeechBlock - 1) / kSpeechBlock);
  }
}

// An offset of the recorder ends where zeros begin.
TEST(SpeechPart, AnOffsetIsNoSpeech) {
  std::vector<float> samples(48000, 0.1f);
  for (std::size_t i = 20000; i < 30000; ++i) samples[i] += 0.2f * std::sin(0.3f * float(i));
  samples.insert(samples.begin(), 16000, 0.0f);
  const SpeechPart part = find_speech(samples);
  EXPECT_EQ(part.first % kSpeechBlock, 0u);
  EXPECT_NEAR(double(part.first), 36000 - 8000, 400);
  EXPECT_NEAR(double(part.samples.size()), 10000 + 16000, 800);
}

}  // namespace padded_test
}  // namespace animeme::voice
