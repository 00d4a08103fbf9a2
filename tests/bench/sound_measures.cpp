#include "tests/bench/sound_measures.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace animeme::bench {
namespace {

constexpr double kFrameSeconds = 0.046, kBandBark = 0.5;
constexpr double kQuiet = -40;        // dB of the loudest frame
constexpr double kFloor = 1e-9;       // power of full scale that nobody hears in a band
constexpr double kDisturbing = 1.41;  // 1.5 dB

double bark(double hertz) { return 7 * std::asinh(hertz / 650); }
double decibel(double power) { return 10 * std::log10(power); }

// In place, length a power of two.
void transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length *= 2) {
    const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi / double(length));
    for (std::size_t begin = 0; begin < n; begin += length) {
      std::complex<double> w = 1;
      for (std::size_t k = begin; k < begin + length / 2; ++k, w *= turn) {
        const std::complex<double> odd = x[k + length / 2] * w;
        x[k + length / 2] = x[k] - odd;
        x[k] += odd;
      }
    }
  }
}

class Bands {
 public:
  Bands(std::size_t size, int sample_rate) : size_(size) {
    for (std::size_t bin = 1; bin < size / 2; ++bin) {
      band_.push_back(std::size_t(bark(double(bin) * sample_rate / double(size)) / kBandBark));
    }
    count_ = band_.back() + 1;
  }

  std::size_t count() const { return count_; }

  /// Power of each band in the frame that begins at `x`, Hann window.
  std::vector<double> powers(const double* x) const {
    std::vector<std::complex<double>> spectrum(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      const double phase = 2 * std::numbers::pi * double(i) / double(size_);
      spectrum[i] = x[i] * (0.5 - 0.5 * std::cos(phase));
    }
    transform(spectrum);
    std::vector<double> power(count_, 0);
    const double scale = 16 / (3.0 * double(size_) * double(size_));
    for (std::size_t i = 0; i < band_.size(); ++i) {
      power[band_[i]] += std::norm(spectrum[i + 1]) * scale;
    }
    return power;
  }

  std::vector<double> mask(const std::vector<double>& power) const {
    std::vector<double> mask(count_, 0);
    for (std::size_t at = 0; at < count_; ++at) {
      for (std::size_t from = 0; from < count_; ++from) {
        const double away = (double(at) - double(from)) * kBandBark;
        mask[at] += power[from] * std::pow(10, (away < 0 ? 27 * away : -15 * away) / 10);
      }
      const double offset = std::max(3.0, 0.25 * (double(at) + 0.5) * kBandBark);
      mask[at] = std::max(mask[at] * std::pow(10, -offset / 10), kFloor);
    }
    return mask;
  }

 private:
  std::size_t size_, count_ = 0;
  std::vector<std::size_t> band_;  // by bin, from bin 1 on
};

double energy(const double* x, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += x[i] * x[i];
  return sum;
}

}  // namespace

SoundDistance sound_distance(std::span<const float> original, std::span<const float> coded,
                             int sample_rate) {
  std::size_t size = 2;
  while (double(size) * 2 <= kFrameSeconds * sample_rate * 1.5) size *= 2;
  const std::size_t length = std::min(original.size(), coded.size());
  const std::vector<double> signal(original.begin(), original.begin() + std::ptrdiff_t(length));
  std::vector<double> noise(length), heard(length);
  for (std::size_t i = 0; i < length; ++i) {
    heard[i] = coded[i];
    noise[i] = heard[i] - signal[i];
  }
  std::vector<std::size_t> begins;
  double loudest = 0;
  for (std::size_t at = 0; at + size <= length; at += size / 2) {
    begins.push_back(at);
    loudest = std::max(loudest, energy(&signal[at], size));
  }
  const Bands bands(size, sample_rate);
  SoundDistance out;
  double ratio = 0;
  for (const std::size_t at : begins) {
    const double power = energy(&signal[at], size);
    if (power <= loudest * std::pow(10, kQuiet / 10)) continue;
    ++out.frames;
    const double error = energy(&noise[at], size);
    out.snr += std::clamp(error > 0 ? decibel(power / error) : 35.0, -10.0, 35.0);
    const auto in = bands.powers(&signal[at]), off = bands.powers(&noise[at]),
               back = bands.powers(&heard[at]), mask = bands.mask(in);
    double worst = 0, sum = 0, distance = 0;
    for (std::size_t b = 0; b < bands.count(); ++b) {
      worst = std::max(worst, off[b] / mask[b]);
      sum += off[b] / mask[b];
      const double apart = decibel((back[b] + kFloor) / (in[b] + kFloor));
      distance += apart * apart;
    }
    ratio += sum / double(bands.count());
    out.spectrum += std::sqrt(distance / double(bands.count()));
    out.disturbed += worst > kDisturbing ? 1 : 0;
  }
  if (out.frames == 0) return out;
  const auto frames = double(out.frames);
  out.snr /= frames;
  out.spectrum /= frames;
  out.disturbed /= frames;
  out.nmr = decibel(ratio / frames);
  return out;
}

}  // namespace animeme::bench
