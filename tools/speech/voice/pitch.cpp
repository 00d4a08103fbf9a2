#include "tools/speech/voice/pitch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace animeme::voice {
namespace {

constexpr int kRate = 4000;                     // Hz, about
constexpr double kStep = 0.01, kWindow = 0.03;  // seconds
constexpr double kLowest = 60, kHighest = 400;  // Hz
constexpr float kVoiced = 0.55f;                // correlation
constexpr float kQuiet = 0.01f;                 // of the loudest frame
constexpr float kOctave = 0.25f;                // what a jump by an octave costs, in correlation
constexpr float kLonger = 0.1f;                 // likewise, for the longest period: multiples

float product(const float* a, const float* b, std::size_t count) {
  std::array<float, 8> sums = {};
  std::size_t i = 0;
  for (; i + sums.size() <= count; i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += a[i + k] * b[i + k];
  float sum = 0;
  for (; i < count; ++i) sum += a[i] * b[i];
  for (const float one : sums) sum += one;
  return sum;
}

/// Correlations of the frame that begins at `from` with those `shortest`, shortest + 1 ... later.
void correlate(const std::vector<float>& sound, std::size_t from, std::size_t window,
               std::size_t shortest, std::vector<float>& out) {
  const float* frame = &sound[from];
  const float energy = product(frame, frame, window);
  float later = product(frame + shortest, frame + shortest, window);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* shifted = frame + shortest + i;
    const float scale = energy * later;
    out[i] = scale > 0 ? product(frame, shifted, window) / std::sqrt(scale) : 0;
    later += shifted[window] * shifted[window] - shifted[0] * shifted[0];
    later = std::max(later, 0.0f);
  }
}

/// The period in samples, 0 without a voice. `before`: of the frame before, or 0.
float period_of(const std::vector<float>& correlation, std::size_t shortest, float before) {
  float best = 0, period = 0;
  for (std::size_t i = 1; i + 1 < correlation.size(); ++i) {
    const float here = correlation[i];
    if (here < kVoiced || here < correlation[i - 1] || here <= correlation[i + 1]) continue;
    // The peak lies between samples.
    const float bend = correlation[i - 1] - 2 * here + correlation[i + 1];
    const float offset = bend < 0 ? 0.5f * (correlation[i - 1] - correlation[i + 1]) / bend : 0.0f;
    const float lag = float(shortest + i) + std::clamp(offset, -0.5f, 0.5f);
    float value = here - kLonger * float(i) / float(correlation.size());
    if (before > 0) value -= kOctave * std::min(1.0f, std::abs(std::log2(lag / before)));
    if (value <= best) continue;
    best = value;
    period = lag;
  }
  return period;
}

// The median over five frames of those with a voice; frames with few of them about are dropped.
std::vector<float> settled(const std::vector<float>& pitch) {
  std::vector<float> out(pitch.size());
  for (std::size_t i = 0; i < pitch.size(); ++i) {
    if (pitch[i] <= 0) continue;
    std::array<float, 5> values = {};  // ascending
    std::size_t count = 0;
    for (std::size_t k = i < 2 ? 0 : i - 2; k < std::min(i + 3, pitch.size()); ++k) {
      if (pitch[k] <= 0) continue;
      std::size_t place = count++;
      for (; place > 0 && values[place - 1] > pitch[k]; --place) values[place] = values[place - 1];
      values[place] = pitch[k];
    }
    if (count < 3) continue;
    out[i] = values[count / 2];
  }
  return out;
}

}  // namespace

float ProsodyMeter::Average::next(float sample) {
  sum += double(sample);
  sum -= double(last[at]);  // zeros in front
  last[at] = sample;
  at = at + 1 == last.size() ? 0 : at + 1;
  return float(sum / double(last.size()));
}

ProsodyMeter::ProsodyMeter(int sample_rate)
    : sample_rate_(sample_rate),
      ratio_(std::size_t(std::max(1, sample_rate / kRate))),
      lead_(std::size_t(kWindow * double(sample_rate) / double(ratio_)) / 2) {
  first_.last.resize(ratio_);
  second_.last.resize(ratio_);
  thin_.resize(lead_);  // the first frame lies about 0
}

// Every `ratio`th sample of two moving averages in a row, which lag by ratio - 1 samples.
void ProsodyMeter::push(std::span<const float> samples) {
  for (const float sample : samples) {
    const float value = ratio_ > 1 ? second_.next(first_.next(sample)) : sample;
    if (++samples_ % ratio_ == 0) thin_.push_back(value);
  }
}

dam::Prosody measure_prosody(const media::Pcm& sound) {
  ProsodyMeter meter(sound.sample_rate);
  meter.push(sound.samples);
  return meter.finish();
}

dam::Prosody ProsodyMeter::finish() {
  dam::Prosody prosody;
  prosody.step = kStep;
  if (sample_rate_ < kRate || samples_ == 0) return prosody;
  const double rate = double(sample_rate_) / double(ratio_);
  std::vector<float>& thin = thin_;
  const auto window = std::size_t(kWindow * rate);
  const auto shortest = std::size_t(rate / kHighest), longest = std::size_t(rate / kLowest) + 1;
  const auto frames = std::size_t(std::ceil(double(samples_) / double(sample_rate_) / kStep));
  // The last frame lies beyond the end.
  thin.resize(std::max(thin.size(), std::size_t(double(frames) * kStep * rate)) + window + longest +
              2);
  std::vector<float> level(frames), pitch(frames), correlation(longest - shortest + 1);
  for (std::size_t i = 0; i < frames; ++i) {
    const float* frame = &thin[std::size_t(double(i) * kStep * rate)];
    level[i] = std::sqrt(product(frame, frame, window) / float(window));
  }
  const float loudest = frames > 0 ? *std::max_element(level.begin(), level.end()) : 0;
  float before = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    if (!(level[i] > kQuiet * loudest)) {
      before = 0;
      continue;
    }
    correlate(thin, std::size_t(double(i) * kStep * rate), window, shortest, correlation);
    const float period = period_of(correlation, shortest, before);
    if (period > 0) pitch[i] = float(rate) / period;
    before = period;
  }
  prosody.pitch = settled(pitch);
  prosody.level = std::move(level);
  return prosody;
}

}  // namespace animeme::voice
