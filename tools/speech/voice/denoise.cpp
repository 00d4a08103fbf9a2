#include "tools/speech/voice/denoise.h"

#include <speex/speex_preprocess.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <numeric>

#include "tools/speech/voice/align.h"

namespace animeme::voice {

namespace {

constexpr double kRumble = 100;  // Hz; the model listens from 130 on, through windows that leak
// The model has learned from recordings with about so much between speech and noise. Noise is
// lowered to there, no further: what is deeper loses weak sounds and moves the cepstral mean.
constexpr double kEnough = 35;                    // dB
constexpr double kMost = 30;                      // dB to take away
constexpr std::size_t kBlock = kAlignRate / 100;  // a block of speexdsp
constexpr std::size_t kLearn = 20 * kAlignRate;   // samples to know the noise from, beforehand
constexpr int kReach = 4;                         // blocks to each side that levels are smoothed by

// A second-order Butterworth high-pass, there and back, so that it delays nothing.
void take_rumble(std::vector<float>& samples) {
  const double k = std::tan(std::numbers::pi * kRumble / kAlignRate);
  const double norm = 1 / (1 + k * std::numbers::sqrt2 + k * k);
  const double a1 = 2 * (k * k - 1) * norm, a2 = (1 - k * std::numbers::sqrt2 + k * k) * norm;
  for (int way = 0; way < 2; ++way) {
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    for (float& sample : samples) {
      const double x = double(sample);
      const double y = norm * (x - 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = x, y2 = y1, y1 = y;
      sample = float(y);
    }
    std::reverse(samples.begin(), samples.end());
  }
}

struct FreeDenoiser {
  void operator()(SpeexPreprocessState* state) const { speex_preprocess_state_destroy(state); }
};

std::int16_t to_int(float sample) {
  return std::int16_t(std::clamp(std::lround(double(sample) * 32768), -32768l, 32767l));
}

// How far the speech stands above the noise, dB, 0 to 100: the power of the louder quarter of the
// recording to that of its quietest seventh.
double measured_snr(const std::vector<float>& samples) {
  std::vector<double> levels;
  for (std::size_t at = 0; at + kBlock <= samples.size(); at += kBlock) {
    double sum = 1e-12;
    for (std::size_t i = at; i < at + kBlock; ++i) sum += double(samples[i]) * double(samples[i]);
    levels.push_back(sum);
  }
  if (levels.size() <= 2 * kReach) return 0;
  std::vector<double> smooth;
  double sum = std::accumulate(levels.begin(), levels.begin() + 2 * kReach, 0.0);
  for (std::size_t i = 2 * kReach; i < levels.size(); ++i) {
    sum += levels[i];
    smooth.push_back(sum);
    sum -= levels[i - 2 * kReach];
  }
  std::sort(smooth.begin(), smooth.end());
  const auto mean = [&](std::size_t first, std::size_t last) {
    return std::accumulate(smooth.begin() + std::ptrdiff_t(first),
                           smooth.begin() + std::ptrdiff_t(last), 0.0) /
           double(last - first);
  };
  const double quiet = std::max(mean(0, smooth.size() / 7 + 1), 1e-9);
  const double loud = mean(smooth.size() - smooth.size() / 4 - 1, smooth.size()) - quiet;
  return std::clamp(10 * std::log10(std::max(loud, 1e-9) / quiet), 0.0, 100.0);
}

}  // namespace

std::vector<float> denoised(const std::vector<float>& samples) {
  std::vector<float> out = samples;
  for (float& sample : out) sample = std::isfinite(sample) ? std::clamp(sample, -1.0f, 1.0f) : 0;
  take_rumble(out);
  int strength = -int(std::lround(std::clamp(kEnough - measured_snr(out), 0.0, kMost)));
  if (strength == 0) return out;
  const std::unique_ptr<SpeexPreprocessState, FreeDenoiser> state(
      speex_preprocess_state_init(int(kBlock), kAlignRate));
  int on = 1;
  speex_preprocess_ctl(state.get(), SPEEX_PREPROCESS_SET_DENOISE, &on);
  speex_preprocess_ctl(state.get(), SPEEX_PREPROCESS_SET_NOISE_SUPPRESS, &strength);
  const auto run = [&](std::size_t at, std::int16_t* block) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      block[i] = at + i < samples.size() ? to_int(out[at + i]) : std::int16_t(0);
    }
    speex_preprocess_run(state.get(), block);
  };
  std::int16_t block[kBlock];
  for (std::size_t at = 0; at < std::min(kLearn, out.size()); at += kBlock) run(at, block);
  // What comes out is late by one block, which is read already when it is overwritten.
  run(0, block);
  for (std::size_t at = 0; at < out.size(); at += kBlock) {
    run(at + kBlock, block);
    for (std::size_t i = 0; i < kBlock && at + i < out.size(); ++i) {
      out[at + i] = float(block[i]) / 32768.0f;
    }
  }
  return out;
}

}  // namespace animeme::voice
