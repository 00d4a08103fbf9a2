#include "tools/speech/voice/speech_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace animeme::voice {

namespace {

constexpr double kPartRate = 16000;
constexpr double kRumbleHertz =
    100;                            // Hz; the model listens from 130 on, through windows that leak
constexpr float kPartLevel = 0.2f;  // what `loud` becomes; other peaks stay below full scale
// What 16 bit tell apart from nothing, and what a voice of any level does.
constexpr float kZero = 1.5f / 32768, kZeroOfPeak = 0.01f;

// Blocks.
constexpr std::size_t kMarginBlocks = 50, kEndBlocks = 50, kFloorBlocks = 6, kEndFloorBlocks = 6,
                      kLoudBlocks = 20;
constexpr std::size_t kRunBlocks = 6;       // of speech; a click is shorter
constexpr std::size_t kSecondBlocks = 100;  // levels are compared by the second ...
constexpr std::size_t kSecondsAround = 15;  // ... with so many to either side
constexpr std::size_t kSnrReach = 4;        // to either side that levels are smooth_powers by

constexpr double kSoundGap = 4;  // what noise of some 10 ms may be below its mean, in power

// dB
constexpr double kLeastRange = 6;  // speech stands out by more
constexpr double kMostRange = 50;  // what is lower is no room, but nothing
constexpr double kRangeShare = 0.25, kLeastAbove = 3,
                 kMostAbove = 12;                // of the range, above the floor
constexpr double kAboveEnd = 8, kBelowLoud = 6;  // the noise at an end may be another one

// A second-order Butterworth high-pass, there and back, so that it delays nothing. Before the first
// sample lies a constant, so that an offset makes no click.
void take_rumble(std::vector<float>& samples) {
  const double k = std::tan(std::numbers::pi * kRumbleHertz / kPartRate);
  const double norm = 1 / (1 + k * std::numbers::sqrt2 + k * k);
  const double a1 = 2 * (k * k - 1) * norm, a2 = (1 - k * std::numbers::sqrt2 + k * k) * norm;
  for (int way = 0; way < 2 && !samples.empty(); ++way) {
    double x1 = double(samples[0]), x2 = x1, y1 = 0, y2 = 0;
    for (float& sample : samples) {
      const double x = double(sample);
      const double y = norm * (x - 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = x, y2 = y1, y1 = y;
      sample = float(y);
    }
    std::reverse(samples.begin(), samples.end());
  }
}

double in_db(double power) { return 10 * std::log10(power + 1e-12); }

std::vector<double> powers_of(std::span<const float> samples) {
  std::vector<double> powers;
  for (std::size_t at = 0; at < samples.size(); at += kSpeechBlock) {
    const std::size_t end = std::min(at + kSpeechBlock, samples.size());
    double sum = 0;
    for (std::size_t i = at; i < end; ++i) sum += double(samples[i]) * double(samples[i]);
    powers.push_back(sum / double(end - at));
  }
  return powers;
}

// The mean of `reach` to either side, as far as there are some.
std::vector<double> smooth_powers(const std::vector<double>& powers, std::size_t reach) {
  std::vector<double> sums{0}, out;
  for (const double power : powers) sums.push_back(sums.back() + power);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const std::size_t first = i > reach ? i - reach : 0;
    const std::size_t last = std::min(i + reach + 1, powers.size());
    out.push_back((sums[last] - sums[first]) / double(last - first));
  }
  return out;
}

// The lowest mean of `length` blocks in a row.
double lowest(std::span<const double> powers, std::size_t length) {
  length = std::min(length, powers.size());
  if (length == 0) return 0;
  double sum = std::accumulate(powers.begin(), powers.begin() + std::ptrdiff_t(length), 0.0);
  double best = sum;
  for (std::size_t i = length; i < powers.size(); ++i) {
    sum += powers[i] - powers[i - length];
    best = std::min(best, sum);
  }
  return std::max(best, 0.0) / double(length);
}

// Exceeded by `count` blocks, or a tenth of a short recording: neither a click nor a share of the
// whole.
double level_of_loud(std::vector<double> powers, std::size_t count) {
  count = std::min(count, powers.size() / 10);
  const auto at = powers.begin() + std::ptrdiff_t(count);
  std::nth_element(powers.begin(), at, powers.end(), std::greater<>());
  return *at;
}

double above_floor(double range) {
  return std::clamp(kRangeShare * range, kLeastAbove, kMostAbove);
}

struct BlockRange {
  std::size_t first = 0, last = 0;  // `last` is behind it
};

// The first block of the first run of kRunBlocks blocks above a level (dB); their number if there
// is none.
std::size_t begin_of_speech(std::span<const double> levels, double level) {
  std::size_t run = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    run = levels[i] > level ? run + 1 : 0;
    if (run == kRunBlocks) return i + 1 - kRunBlocks;
  }
  return levels.size();
}

// The blocks from the first speech to the last, with a margin.
BlockRange speech_of(const std::vector<double>& powers) {
  const BlockRange all{0, powers.size()};
  if (powers.size() < 2 * kRunBlocks) return all;
  std::vector<double> levels;
  for (const double power : smooth_powers(powers, 1)) levels.push_back(in_db(power));
  const double loud = level_of_loud(levels, kLoudBlocks);
  const double floor = std::max(in_db(lowest(powers, kFloorBlocks)), loud - kMostRange);
  if (loud - floor < kLeastRange) return all;
  const double least = floor + above_floor(loud - floor);
  const auto find = [&](const std::vector<double>& some, std::vector<double> of) {
    const auto end = std::span(some).first(std::min(kEndBlocks, some.size()));
    const double noise =
        std::min(in_db(lowest(end, kEndFloorBlocks)) + kAboveEnd, loud - kBelowLoud);
    return begin_of_speech(of, std::max(least, noise));
  };
  const std::size_t first = find(powers, levels);
  const std::size_t behind =
      find({powers.rbegin(), powers.rend()}, {levels.rbegin(), levels.rend()});
  if (first + behind >= powers.size()) return all;
  return {first > kMarginBlocks ? first - kMarginBlocks : 0,
          std::min(powers.size() - behind + kMarginBlocks, powers.size())};
}

// Which blocks are speech, where the room and the voice may change in time.
std::vector<std::uint8_t> speech_blocks(const std::vector<double>& powers) {
  const std::vector<double> wide = smooth_powers(powers, kSnrReach),
                            narrow = smooth_powers(powers, 1);
  const std::size_t seconds = (powers.size() + kSecondBlocks - 1) / kSecondBlocks;
  std::vector<double> floors, tops;
  for (std::size_t s = 0; s < seconds; ++s) {
    // With what the next second has of it, so that no window is lost at their border.
    const std::size_t first = s * kSecondBlocks,
                      count = std::min(kSecondBlocks, powers.size() - first);
    const std::size_t more = std::min(count + kFloorBlocks, powers.size() - first);
    const std::size_t from =
        more < kFloorBlocks && powers.size() >= kFloorBlocks ? powers.size() - kFloorBlocks : first;
    floors.push_back(
        in_db(lowest(std::span(powers).subspan(from, first + more - from), kFloorBlocks)));
    tops.push_back(in_db(*std::max_element(wide.begin() + std::ptrdiff_t(first),
                                           wide.begin() + std::ptrdiff_t(first + count))));
  }
  std::vector<std::uint8_t> speech(powers.size());
  for (std::size_t s = 0; s < seconds; ++s) {
    const std::size_t from = s > kSecondsAround ? s - kSecondsAround : 0;
    const std::size_t to = std::min(s + kSecondsAround + 1, seconds);
    const double loud =
        *std::max_element(tops.begin() + std::ptrdiff_t(from), tops.begin() + std::ptrdiff_t(to));
    const double floor =
        std::max(loud - kMostRange, *std::min_element(floors.begin() + std::ptrdiff_t(from),
                                                      floors.begin() + std::ptrdiff_t(to)));
    if (loud - floor < kLeastRange) continue;
    const double least = floor + above_floor(loud - floor);
    for (std::size_t i = s * kSecondBlocks; i < std::min((s + 1) * kSecondBlocks, powers.size());
         ++i) {
      speech[i] = in_db(narrow[i]) > least ? 1 : 0;
    }
  }
  return speech;
}

double mean_power(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         double(std::max<std::size_t>(values.size(), 1));
}

// The power of the louder part of the speech to that of the quietest seventh of all.
double snr_of(const std::vector<double>& powers, const std::vector<std::uint8_t>& speech) {
  if (powers.size() <= 2 * kSnrReach) return 0;
  std::vector<double> all = smooth_powers(powers, kSnrReach), loud;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (speech[i] != 0) loud.push_back(all[i]);
  }
  std::sort(all.begin(), all.end());
  std::sort(loud.begin(), loud.end());
  // Speech without pauses is quiet between its sounds only, and where it fades out.
  const double between =
      kSoundGap * std::min({lowest(powers, kFloorBlocks), powers.front(), powers.back()});
  const double quiet =
      std::max(std::min(mean_power(std::span(all).first(all.size() / 7 + 1)), between), 1e-12);
  const double top = loud.empty() ? mean_power(std::span(all).last(all.size() / 4 + 1))
                                  : mean_power(std::span(loud).last((loud.size() + 2) / 3));
  return std::clamp(10 * std::log10(std::max(top - quiet, 1e-12) / quiet), 0.0, 100.0);
}

float loudness_of(std::span<const float> samples, const std::vector<std::uint8_t>& speech) {
  const bool any = std::find(speech.begin(), speech.end(), 1) != speech.end();
  std::vector<float> peaks;
  for (std::size_t i = 0; i < speech.size(); ++i) {
    if (any && speech[i] == 0) continue;
    float peak = 0;
    const std::size_t end = std::min((i + 1) * kSpeechBlock, samples.size());
    for (std::size_t k = i * kSpeechBlock; k < end; ++k)
      peak = std::max(peak, std::abs(samples[k]));
    peaks.push_back(peak);
  }
  if (peaks.empty()) return 0;
  const auto high = peaks.begin() + std::ptrdiff_t(0.9 * double(peaks.size() - 1));
  std::nth_element(peaks.begin(), high, peaks.end());
  return *high;
}

// The samples between what is nothing at either end. Behind many zeros they begin with the first
// sound, so that the same frames are heard however many there are; a few stay, so that frames lie
// where other programs have them.
BlockRange without_zeros(std::span<const float> samples) {
  float peak = 0;
  for (const float sample : samples) peak = std::max(peak, std::abs(sample));
  if (peak == 0) return {0, samples.size()};
  const float least = std::min(kZero, kZeroOfPeak * peak);
  const auto heard = [&](float sample) { return std::abs(sample) > least; };
  const auto first = std::find_if(samples.begin(), samples.end(), heard);
  const auto last = std::find_if(samples.rbegin(), samples.rend(), heard);
  const auto zeros = std::size_t(first - samples.begin());
  return {zeros > kMarginBlocks * kSpeechBlock ? zeros : 0, std::size_t(samples.rend() - last)};
}

// In place: an hour of sound is 230 MB.
void keep_samples(std::vector<float>& samples, std::size_t first, std::size_t last) {
  samples.erase(samples.begin() + std::ptrdiff_t(last), samples.end());
  samples.erase(samples.begin(), samples.begin() + std::ptrdiff_t(first));
}

}  // namespace

SpeechPart find_speech(std::vector<float> recording) {
  for (float& sample : recording) {
    sample = std::isfinite(sample) ? std::clamp(sample, -1.0f, 1.0f) : 0;
  }
  SpeechPart part;
  const BlockRange sound = without_zeros(recording);
  part.samples = std::move(recording);
  keep_samples(part.samples, sound.first, sound.last);
  take_rumble(part.samples);
  std::vector<double> powers = powers_of(part.samples);
  const BlockRange blocks = speech_of(powers);
  const std::size_t first = blocks.first * kSpeechBlock;
  const std::size_t last = std::min(blocks.last * kSpeechBlock, part.samples.size());
  part.first = sound.first + first;
  keep_samples(part.samples, first, last);
  powers = {powers.begin() + std::ptrdiff_t(blocks.first),
            powers.begin() + std::ptrdiff_t(blocks.last)};
  part.speech = speech_blocks(powers);
  part.snr = snr_of(powers, part.speech);
  part.loud = loudness_of(part.samples, part.speech);
  if (part.loud <= 0) return part;
  const float gain = kPartLevel / part.loud;
  for (float& sample : part.samples) sample = std::clamp(gain * sample, -1.0f, 1.0f);
  part.loud = kPartLevel;
  return part;
}

}  // namespace animeme::voice
