// Speed of the codec in planes a second of CPU time, beside that of a textbook coder which writes
// the same bits (textbook_coder.h). `tight` has the ranges of the clip, `wide` +-1860; the
// counter x_textbook is the ratio to the textbook row above, in the same run.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "fap/text.h"
#include "tests/bench/bench_material.h"

namespace animeme::bench {
namespace {

// CPU planes a second of the latest textbook run, by benchmark.
std::map<std::string, double>& textbook_rates() {
  static std::map<std::string, double> rates;
  return rates;
}

// Runs `work` and reports its speed; planes a second of this thread's CPU time.
template <class Work>
double measure(benchmark::State& state, const Material& material, const Work& work) {
  const std::clock_t start = std::clock();
  for (auto _ : state) work();
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  const double planes = double(material.planes.size());
  state.counters["planes/s"] =
      benchmark::Counter(planes * double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bits/plane"] = double(material.stream.size()) * 8 / planes;
  return seconds > 0 ? planes * double(state.iterations()) / seconds : 0;
}

template <class Work>
void fast(benchmark::State& state, const std::string& name, const Material& material,
          const Work& work) {
  const double rate = measure(state, material, work);
  const auto slow = textbook_rates().find(name);
  if (slow != textbook_rates().end() && slow->second > 0) {
    state.counters["x_textbook"] = rate / slow->second;
  }
}

void compare(const std::string& name, const Material& material) {
  const auto row = [&name](const char* what, auto function) {
    benchmark::RegisterBenchmark((what + name).c_str(), function)->Unit(benchmark::kMillisecond);
  };
  const std::string decoding = "decode_" + name;
  const std::string encoding = "encode_" + name;
  row("textbook/decode_", [&material, decoding](benchmark::State& state) {
    textbook_rates()[decoding] = measure(state, material, [&material] {
      benchmark::DoNotOptimize(
          textbook::decode(material.layout, material.stream, material.planes.size()));
    });
  });
  row("decode_", [&material, decoding](benchmark::State& state) {
    fast(state, decoding, material,
         [&material] { benchmark::DoNotOptimize(fba::decode(material.stream)); });
  });
  row("textbook/encode_", [&material, encoding](benchmark::State& state) {
    textbook_rates()[encoding] = measure(state, material, [&material] {
      benchmark::DoNotOptimize(textbook::encode(material.layout, material.planes));
    });
  });
  row("encode_", [&material, encoding](benchmark::State& state) {
    fast(state, encoding, material,
         [&material] { benchmark::DoNotOptimize(encode_planes(material)); });
  });
}

// A whole clip: decisions, coding, and the check of the result by decoding it again.
void encode_whole(benchmark::State& state, const fba::EncodeOptions& options, int frames) {
  const fap::Sequence clip = moving_face(frames);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = fba::encode(clip, options)->size();
  state.counters["planes/s"] =
      benchmark::Counter(double(frames) * double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bits/plane"] = double(bytes) * 8 / frames;
}

void encode_preset_plain(benchmark::State& state) { encode_whole(state, {}, 2000); }
void encode_preset_file(benchmark::State& state) { encode_whole(state, fba::file_options(), 2000); }
void encode_preset_file_rms2(benchmark::State& state) {
  fba::EncodeOptions options = fba::file_options();
  options.max_rms = 2;
  encode_whole(state, options, 200);
}

void encode_preset_live(benchmark::State& state) {
  const fap::Sequence clip = moving_face(2000);
  std::size_t bytes = 0;
  for (auto _ : state) {
    fba::LiveEncoder encoder;
    bytes = 0;
    for (const fap::Frame& frame : clip.frames) bytes += encoder.write(frame)->size();
  }
  state.counters["planes/s"] =
      benchmark::Counter(2000.0 * double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bits/plane"] = double(bytes) * 8 / 2000;
}

void read_fap_text(benchmark::State& state) {
  const std::string text = fap::write_text(moving_face(2000));
  for (auto _ : state) benchmark::DoNotOptimize(fap::read_text(text));
  state.SetBytesProcessed(std::int64_t(text.size()) * std::int64_t(state.iterations()));
}

}  // namespace
}  // namespace animeme::bench

int main(int argc, char** argv) {
  using namespace animeme::bench;
  const std::vector<Material> all = {wide_face(), tight_face(), visemes(), body()};
  for (const Material& material : all) {
    const std::string problem = check(material);
    if (!problem.empty()) {
      std::fprintf(stderr, "bench_codec: %s: %s\n", material.name.c_str(), problem.c_str());
      return EXIT_FAILURE;
    }
    compare(material.name, material);
  }
  const auto add = [](const char* name, void (*function)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, function)->Unit(benchmark::kMillisecond);
  };
  add("encode_preset_plain", encode_preset_plain);
  add("encode_preset_file", encode_preset_file);
  add("encode_preset_file_rms2", encode_preset_file_rms2);
  add("encode_preset_live", encode_preset_live);
  add("read_fap_text", read_fap_text);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
