// Speed of the models: training on ten minutes of speech, synthesis, loading.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <string>

#include "dam/corpus/corpus.h"
#include "dam/model/builtin.h"
#include "dam/speaking/stream.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/bench/speech_material.h"

namespace animeme {
namespace {

constexpr double kTenMinutes = 600;

dam::TrainOptions options_of(dam::Method method) {
  dam::TrainOptions options;
  options.method = method;
  return options;
}

/// Largest memory of the process up to now, which is that of the largest benchmark before.
double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

void train(benchmark::State& state, dam::Method method) {
  const auto sentences = bench::made_up_speech(kTenMinutes, std::size_t(state.range(0)));
  for (auto _ : state) {
    const auto model = dam::train(sentences, options_of(method));
    benchmark::DoNotOptimize(model);
    if (!model) state.SkipWithError(model.error().message.c_str());
  }
  state.counters["peak_MB"] = peak_megabytes();
}

/// Speaks the sample with a model of 68 controls.
void synthesise(benchmark::State& state, dam::Method method) {
  const auto model =
      dam::train(bench::made_up_speech(60, std::size_t(state.range(0))), options_of(method));
  if (!model) return state.SkipWithError(model.error().message.c_str());
  const dam::Corpus corpus = bench::sample_corpus();
  std::size_t phones = 0, frames = 0;
  for (auto _ : state)
    for (const dam::Utterance& utterance : corpus.utterances) {
      const auto signal = dam::synthesise(*model, utterance.script);
      benchmark::DoNotOptimize(signal);
      phones += utterance.script.phones.size();
      frames += signal->frames();
    }
  const auto rate = benchmark::Counter::kIsRate | benchmark::Counter::kInvert;
  state.counters["s/phone"] = benchmark::Counter(double(phones), rate);
  state.counters["s/frame"] = benchmark::Counter(double(frames), rate);
}

/// The same phone by phone, as a live voice would.
void stream(benchmark::State& state) {
  const auto model = dam::builtin_model();
  const dam::Corpus corpus = bench::sample_corpus();
  std::size_t frames = 0;
  for (auto _ : state)
    for (const dam::Utterance& utterance : corpus.utterances) {
      dam::SpeechStream stream(*model, {});
      for (const dam::Phone& phone : utterance.script.phones) {
        benchmark::DoNotOptimize(stream.push(phone));
        frames += stream.pull()->frames();
      }
      frames += stream.finish()->frames();
    }
  state.counters["s/frame"] =
      benchmark::Counter(double(frames), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(stream)->Unit(benchmark::kMillisecond);

void load_builtin_model(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(dam::builtin_model());
}
BENCHMARK(load_builtin_model)->Unit(benchmark::kMicrosecond);

/// Every method, also those to come.
const bool kRegistered = [] {
  for (const dam::Method method : dam::methods()) {
    const std::string name(dam::method_name(method));
    benchmark::RegisterBenchmark(("train_ten_minutes/" + name).c_str(),
                                 [method](benchmark::State& state) { train(state, method); })
        ->Arg(16)
        ->Arg(68)
        ->ArgName("controls")
        ->Iterations(1)
        ->UseRealTime()
        ->Unit(benchmark::kSecond);
    benchmark::RegisterBenchmark(("synthesise/" + name).c_str(),
                                 [method](benchmark::State& state) { synthesise(state, method); })
        ->Arg(26)
        ->Arg(68)
        ->ArgName("controls")
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace animeme
