#include "tools/speech/voice/denoise.h"

#include <speex/speex_preprocess.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "tools/speech/voice/align.h"

namespace animeme::voice {

namespace {

// The model has learned from recordings with about so much between speech and noise. Noise is
// lowered to there, no further: what is deeper loses weak sounds and moves the cepstral mean.
constexpr double kEnough = 35;                    // dB
constexpr double kMost = 30;                      // dB to take away
constexpr std::size_t kBlock = kAlignRate / 100;  // a block of speexdsp
constexpr std::size_t kLearn = 20 * kAlignRate;   // samples to know the noise from, beforehand

struct FreeDenoiser {
  void operator()(SpeexPreprocessState* state) const { speex_preprocess_state_destroy(state); }
};

std::int16_t to_int(float sample) {
  return std::int16_t(std::clamp(std::lround(double(sample) * 32768), -32768l, 32767l));
}

}  // namespace

void denoise(const std::vector<float>& samples, double snr,
             const std::function<void(std::span<const float>)>& take) {
  int strength = -int(std::lround(std::clamp(kEnough - snr, 0.0, kMost)));
  if (strength == 0) return take(samples);
  const std::unique_ptr<SpeexPreprocessState, FreeDenoiser> state(
      speex_preprocess_state_init(int(kBlock), kAlignRate));
  int on = 1;
  speex_preprocess_ctl(state.get(), SPEEX_PREPROCESS_SET_DENOISE, &on);
  speex_preprocess_ctl(state.get(), SPEEX_PREPROCESS_SET_NOISE_SUPPRESS, &strength);
  const auto run = [&](std::size_t at, std::int16_t* block) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      block[i] = at + i < samples.size() ? to_int(samples[at + i]) : std::int16_t(0);
    }
    speex_preprocess_run(state.get(), block);
  };
  std::int16_t block[kBlock];
  for (std::size_t at = 0; at < std::min(kLearn, samples.size()); at += kBlock) run(at, block);
  // What comes out is late by one block.
  run(0, block);
  std::array<float, kBlock> out{};
  for (std::size_t at = 0; at < samples.size(); at += kBlock) {
    run(at + kBlock, block);
    for (std::size_t i = 0; i < kBlock; ++i) out[i] = float(block[i]) / 32768.0f;
    take(std::span(out).first(std::min(kBlock, samples.size() - at)));
  }
}

}  // namespace animeme::voice
