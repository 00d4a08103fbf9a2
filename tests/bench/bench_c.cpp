// The C interface beside the libraries behind it, which do the same work in turns, so that a busy
// machine slows both: `x_cpp` is how much more time of the CPU the C interface takes.
#include <animeme/animeme.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "codec/encode/live.h"
#include "tests/bench/bench_material.h"
#include "tests/bench/two_decoders.h"

namespace animeme::bench {
namespace {

// Both in turns.
template <class Cpp, class C>
void compare(benchmark::State& state, std::size_t planes, const Cpp& cpp, const C& c) {
  double of_cpp = 0;
  double of_c = 0;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    if (cpp() != planes) state.SkipWithError("planes are missing");
    const double middle = cpu_seconds();
    if (c() != planes) state.SkipWithError("planes are missing in C");
    of_cpp += middle - begin;
    of_c += cpu_seconds() - middle;
  }
  state.counters["planes/s"] = double(planes) * double(state.iterations()) / of_c;
  state.counters["x_cpp"] = of_c / of_cpp;
}

void decode(benchmark::State& state, const Material& material) {
  const auto by = [&](auto decode) {
    return [&material, decode] {
      const Decoded decoded = decode(material.stream);
      benchmark::DoNotOptimize(decoded.sum);
      return decoded.planes;
    };
  };
  compare(state, material.planes.size(), by(decode_by_cpp), by(decode_by_c));
}

void encode(benchmark::State& state, const Material& material) {
  std::vector<animeme_frame> frames(material.faces.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    animeme_frame_init(&frames[i], sizeof frames[i]);
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      frames[i].present[fap - 1] = material.faces[i].mask[fap];
      frames[i].value[fap - 1] = material.faces[i].value[fap];
    }
  }
  const auto cpp = [&] {
    fba::LiveEncoder encoder;
    std::vector<std::uint8_t> unit;
    std::size_t planes = 0;
    for (const fap::Frame& frame : material.faces) planes += encoder.write(frame, unit) ? 1 : 0;
    return planes;
  };
  const auto c = [&] {
    animeme_encoder* encoder = nullptr;
    animeme_encoder_new(nullptr, &encoder, nullptr);
    const std::uint8_t* bytes = nullptr;
    std::size_t size = 0;
    std::size_t planes = 0;
    for (const animeme_frame& frame : frames) {
      const auto done =
          animeme_encoder_write(encoder, &frame, nullptr, 0, &bytes, &size, nullptr, nullptr);
      planes += done == ANIMEME_OK ? 1 : 0;
    }
    animeme_encoder_free(encoder);
    return planes;
  };
  compare(state, material.faces.size(), cpp, c);
}

[[maybe_unused]] const bool registered = [] {
  static const Material wide = wide_face();
  static const Material tight = tight_face();
  for (const Material* material : {&tight, &wide}) {
    benchmark::RegisterBenchmark(("decode/" + material->name).c_str(),
                                 [material](benchmark::State& state) { decode(state, *material); });
  }
  benchmark::RegisterBenchmark("encode/live",
                               [](benchmark::State& state) { encode(state, tight); });
  return true;
}();

}  // namespace
}  // namespace animeme::bench
