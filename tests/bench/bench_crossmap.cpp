// Frames a second of the two fits of Appendix A. A character of 52 controls moves 126 or 600
// numbers (42 points, 200 vertices); its controls go up and down as those of speech do.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dam/crossmap/bounded_least_squares.h"
#include "dam/maths/random.h"

namespace {

using animeme::dam::BoundedLeastSquares;
using animeme::dam::Random;

constexpr std::size_t kControls = 52, kFrames = 1000;

// A character whose controls move a part of it each and overlap, and a recording of it with noise.
struct Material {
  explicit Material(std::size_t row_count) : rows(row_count) {
    Random random(7);
    matrix.resize(rows * kControls);
    for (std::size_t j = 0; j < kControls; ++j) {
      const double centre = random.between(0, double(rows));
      for (std::size_t i = 0; i < rows; ++i) {
        const double far = (double(i) - centre) / (0.1 * double(rows));
        matrix[i * kControls + j] = std::exp(-far * far) * random.between(0.5, 1.5);
      }
    }
    std::vector<double> phase, speed;
    for (std::size_t j = 0; j < kControls; ++j) {
      phase.push_back(random.between(0, 6.28));
      speed.push_back(random.between(0.02, 0.4));  // rad a frame: to 4 Hz at 60 frames a second
    }
    targets.assign(kFrames * rows, 0.0);
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
      double* target = &targets[frame * rows];
      for (std::size_t j = 0; j < kControls; ++j) {
        const double control =
            std::max(0.0, 0.9 * std::sin(phase[j] + speed[j] * double(frame)) - 0.2);
        for (std::size_t i = 0; i < rows; ++i) target[i] += matrix[i * kControls + j] * control;
      }
      for (std::size_t i = 0; i < rows; ++i) target[i] += random.between(-0.01, 0.01);
    }
  }
  std::span<const double> target(std::size_t frame) const { return {&targets[frame * rows], rows}; }
  std::size_t rows;
  std::vector<double> matrix, targets;
};

void measure(benchmark::State& state, double high, bool warm) {
  const Material material(std::size_t(state.range(0)));
  BoundedLeastSquares fit(material.matrix, material.rows, kControls, {.high = high});
  std::size_t frame = 0, steps = 0;
  for (auto _ : state) {
    if (!warm) fit.restart();
    benchmark::DoNotOptimize(fit.fit(material.target(frame % kFrames)).data());
    steps += fit.steps();
    ++frame;
  }
  state.counters["frames/s"] = benchmark::Counter(double(frame), benchmark::Counter::kIsRate);
  state.counters["steps"] = double(steps) / double(frame);
}

void controls_0_to_1(benchmark::State& state) { measure(state, 1, true); }
void controls_0_to_1_afresh(benchmark::State& state) { measure(state, 1, false); }
void nonnegative(benchmark::State& state) {
  measure(state, std::numeric_limits<double>::infinity(), true);
}

// As fit_controls() does it: vertices are mixtures of 21 key shapes, so that only their products
// are mixed.
void controls_of_mixtures(benchmark::State& state) {
  const Material material(600);
  BoundedLeastSquares fit(material.matrix, material.rows, kControls, {.high = 1});
  constexpr std::size_t kKeys = 21;
  std::vector<std::vector<double>> products;
  for (std::size_t k = 0; k < kKeys; ++k) {
    products.push_back(fit.products(material.target(k * kFrames / kKeys)));
  }
  std::vector<double> mixed(kControls);
  std::size_t frame = 0;
  for (auto _ : state) {
    std::fill(mixed.begin(), mixed.end(), 0.0);
    // Three shapes at a time, that fade into each other.
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t key = (frame / 10 + k) % kKeys;
      const double share = k == 1 ? 0.5 : 0.25 + (k == 0 ? -0.025 : 0.025) * double(frame % 10);
      for (std::size_t c = 0; c < kControls; ++c) mixed[c] += share * products[key][c];
    }
    benchmark::DoNotOptimize(fit.fit_products(mixed).data());
    ++frame;
  }
  state.counters["frames/s"] = benchmark::Counter(double(frame), benchmark::Counter::kIsRate);
}
BENCHMARK(controls_of_mixtures);
BENCHMARK(controls_0_to_1)->Arg(126)->Arg(600);
BENCHMARK(controls_0_to_1_afresh)->Arg(126);
BENCHMARK(nonnegative)->Arg(126);

}  // namespace
