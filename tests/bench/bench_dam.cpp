// Speed of the models: training on the sample corpus that ships with the tests, synthesis with
// the built-in model.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "dam/builtin.h"
#include "dam/corpus.h"
#include "dam/synthesise.h"
#include "dam/train.h"

namespace animeme {
namespace {

dam::Corpus sample() {
  auto corpus = dam::read_corpus(std::filesystem::path(ANIMEME_SOURCE_DIR) / "tests" / "data" /
                                 "grid_s1_sample");
  return corpus ? *corpus : dam::Corpus();
}

void train_sample(benchmark::State& state) {
  const dam::Corpus corpus = sample();
  for (auto _ : state) benchmark::DoNotOptimize(dam::train(corpus.utterances));
  state.counters["speech_s"] = corpus.duration();
  state.counters["controls"] = double(corpus.utterances.front().signal.names.size());
}
BENCHMARK(train_sample)->Unit(benchmark::kMillisecond);

void synthesise(benchmark::State& state) {
  const dam::Corpus corpus = sample();
  const auto model = dam::builtin_model();
  std::size_t phones = 0;
  std::size_t frames = 0;
  for (auto _ : state) {
    for (const dam::Utterance& utterance : corpus.utterances) {
      const auto signal = dam::synthesise(*model, utterance.script);
      benchmark::DoNotOptimize(signal);
      phones += utterance.script.phones.size();
      frames += signal->frames();
    }
  }
  const auto rate = benchmark::Counter::kIsRate | benchmark::Counter::kInvert;
  state.counters["s/phone"] = benchmark::Counter(double(phones), rate);
  state.counters["s/frame"] = benchmark::Counter(double(frames), rate);
}
BENCHMARK(synthesise)->Unit(benchmark::kMillisecond);

void load_builtin_model(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(dam::builtin_model());
}
BENCHMARK(load_builtin_model)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace animeme
