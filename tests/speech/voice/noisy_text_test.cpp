// Texts in noise: right ones are placed, with a warning where they hardly fit; what is something
// else is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/speech/voice/align_support.h"

namespace animeme::voice {
namespace noisy_text_test {

using namespace align_support;  // NOLINT: as if they were here
using testing::Contains;
using testing::HasSubstr;

constexpr const char* kTexts[] = {
    "the farmer drove his old truck across the muddy field before breakfast",
    "seven musicians played quietly behind the curtain while we waited",
    "give the letter to my sister when she comes back from the harbour"};

// White noise of so many dB below the voice.
media::Pcm in_noise(media::Pcm audio, double db) {
  double sum = 0;
  for (const float one : audio.samples) sum += double(one) * double(one);
  const double power = sum / double(audio.samples.size());
  // Uniform noise has a third of the power of its peak.
  add_noise(audio, float(std::sqrt(3 * power * std::pow(10.0, -db / 10))));
  return audio;
}

TEST(NoisyText, TheRightOneIsPlacedAnotherIsRefused) {
  SKIP_WITHOUT_ALIGNER();
  for (std::size_t i = 0; i < std::size(kTexts); ++i) {
    const auto speech = speak_text(kTexts[i]);
    SKIP_WITHOUT_VOICE(speech);
    const media::Pcm clean = resample(speech->audio, kAlignRate);
    const auto truth = align(clean, kTexts[i]);
    ASSERT_TRUE(truth) << truth.error().describe();
    for (const double db : {10.0, 5.0, 0.0}) {
      const media::Pcm audio = in_noise(clean, db);
      const auto found = align(audio, kTexts[i]);
      ASSERT_TRUE(found) << db << " dB: " << found.error().describe();
      if (found->confidence < AlignOptions().least_confidence) {
        EXPECT_THAT(found->warnings, Contains(HasSubstr("hardly fits the recording")));
      }
      std::size_t near = 0;
      for (std::size_t k = 0; k < found->words.size(); ++k) {
        near += std::abs(found->words[k].start - truth->words[k].start) < 0.1;
      }
      EXPECT_GE(2 * near, found->words.size()) << db;
      EXPECT_FALSE(align(audio, kTexts[(i + 1) % std::size(kTexts)])) << db << " dB";
    }
  }
}

}  // namespace noisy_text_test
}  // namespace animeme::voice
