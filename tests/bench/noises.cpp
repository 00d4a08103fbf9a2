#include "tests/bench/noises.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dam/maths/random.h"

namespace animeme::bench {

namespace {

constexpr double kRate = 16000;

// Near enough to a normal distribution: the sum of four uniform ones.
double normal(dam::Random& random) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += random.between(-1, 1);
  return sum * std::sqrt(0.75);
}

// Power that falls as 1/f: white noises, each held twice as long as the one before.
std::vector<float> pink(std::size_t samples, dam::Random& random) {
  double rows[12] = {};
  std::vector<float> out(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    double sum = normal(random);
    for (int row = 0; row < 12; ++row) {
      if ((i >> row) % 2 == 0 || i % (std::size_t(1) << row) != 0) continue;
      rows[row] = normal(random);
    }
    for (const double row : rows) sum += row;
    out[i] = float(sum);
  }
  return out;
}

void add_mains(std::vector<float>& sound, dam::Random& random) {
  for (int harmonic = 1; harmonic <= 8; ++harmonic) {
    const double phase = random.between(0, 2 * std::numbers::pi);
    const double step = 2 * std::numbers::pi * 50 * harmonic / kRate;
    const double level = 6.0 / harmonic;
    for (std::size_t i = 0; i < sound.size(); ++i) {
      sound[i] += float(level * std::sin(phase + step * double(i)));
    }
  }
}

double power(std::span<const float> sound) {
  double sum = 0;
  for (const float sample : sound) sum += double(sample) * double(sample);
  return sum / double(std::max<std::size_t>(sound.size(), 1));
}

// Sixty reflections that fall by 60 dB in 0.4 s, behind the direct sound.
std::vector<float> echo(const std::vector<float>& voice, dam::Random& random) {
  std::vector<float> out = voice;
  for (int i = 0; i < 60; ++i) {
    const double seconds = random.between(0.003, 0.4);
    const double level = 0.35 * random.between(-1, 1) * std::pow(10.0, -3 * seconds / 0.4);
    const auto delay = std::size_t(seconds * kRate);
    for (std::size_t k = delay; k < out.size(); ++k) out[k] += float(level) * voice[k - delay];
  }
  return out;
}

}  // namespace

std::string_view name_of(Noise noise) {
  constexpr std::string_view kNames[] = {"white", "hum", "babble", "room"};
  return kNames[std::size_t(noise)];
}

std::vector<float> make_noise(Noise noise, std::size_t samples, std::uint64_t seed,
                              std::span<const std::vector<float>> others) {
  dam::Random random(seed);
  std::vector<float> out(samples);
  if (noise == Noise::white) {
    for (float& sample : out) sample = float(normal(random));
  } else if (noise == Noise::babble) {
    for (int voice = 0; voice < 8; ++voice) {
      std::size_t who = random.below(others.size()), at = random.below(others[who].size());
      for (float& sample : out) {
        sample += others[who][at];
        if (++at < others[who].size()) continue;
        who = random.below(others.size());
        at = 0;
      }
    }
  } else {
    out = pink(samples, random);
    if (noise == Noise::hum) add_mains(out, random);
  }
  const double scale = 1 / std::sqrt(std::max(power(out), 1e-20));
  for (float& sample : out) sample = float(scale * double(sample));
  return out;
}

std::vector<float> in_noise(const std::vector<float>& voice, std::size_t first, std::size_t last,
                            Noise noise, double db, std::uint64_t seed,
                            std::span<const std::vector<float>> others) {
  dam::Random random(seed ^ 0x5eed);
  std::vector<float> out = noise == Noise::room ? echo(voice, random) : voice;
  const auto sound = make_noise(noise, out.size(), seed, others);
  last = std::min(last, out.size());
  const double speech = power(std::span(out).subspan(first, last - first));
  const double scale = std::sqrt(speech * std::pow(10.0, -db / 10));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += float(scale * double(sound[i]));
  return out;
}

}  // namespace animeme::bench
