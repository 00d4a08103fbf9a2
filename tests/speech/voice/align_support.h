// What tests of the aligner share.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/speech/voice/align.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice::align_support {

inline media::Pcm silence(double seconds, int rate = kAlignRate) {
  return {rate, std::vector<float>(std::size_t(seconds * rate), 0.0f)};
}

// Good enough for a test: linear interpolation after a running mean over one output sample.
inline media::Pcm resample(const media::Pcm& audio, int rate) {
  media::Pcm out{rate, {}};
  const double step = double(audio.sample_rate) / rate;
  const auto count = std::size_t(audio.duration() * rate);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = double(i) * step;
    const auto first = std::size_t(at);
    const double part = at - double(first);
    const float a = audio.samples[first];
    const float b = first + 1 < audio.samples.size() ? audio.samples[first + 1] : a;
    out.samples.push_back(float((1 - part) * double(a) + part * double(b)));
  }
  return out;
}

// Why there is nothing to test: the part is not built, or its model is not installed.
inline std::string missing_part() {
  const AlignOptions defaults;
  if (!std::filesystem::exists(defaults.dictionary_path)) return "pocketsphinx-en-us is missing";
  const auto tried = align(silence(1), "yes");
  return !tried && tried.error().code == Code::unsupported ? tried.error().describe() : "";
}

inline AlignOptions everything() {
  AlignOptions options;
  options.least_confidence = 0;
  return options;
}

// White noise of the same numbers on every machine.
inline void add_noise(media::Pcm& audio, float level) {
  std::uint32_t state = 1;
  for (float& sample : audio.samples) {
    state = state * 1664525u + 1013904223u;
    sample += level * (float(state >> 8) / 8388608.0f - 1.0f);
  }
}

#define SKIP_WITHOUT_ALIGNER()                                                    \
  if (const std::string why = voice::align_support::missing_part(); !why.empty()) \
  GTEST_SKIP() << why

#define SKIP_WITHOUT_VOICE(speech)                         \
  if (!speech && speech.error().code == Code::unsupported) \
    GTEST_SKIP() << speech.error().describe();             \
  ASSERT_TRUE(speech) << speech.error().describe()

}  // namespace animeme::voice::align_support
