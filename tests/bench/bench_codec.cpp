// Speed of the codec in planes a second. `tight` has the ranges of the clip, `wide` +-1860.
#include <benchmark/benchmark.h>

#include <cmath>

#include "codec/decoder.h"
#include "codec/encode.h"
#include "fap/text.h"

namespace animeme {
namespace {

// A face that moves like a talking one: slow waves of different speeds and phases.
fap::Sequence moving_face(int frames) {
  fap::Sequence clip;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const double speed = 0.05 + 0.01 * (fap % 17);
      frame.set(fap, int(std::lround(150 * std::sin(speed * i + fap))));
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

std::vector<std::uint8_t> wide_stream(const fap::Sequence& clip) {
  fba::FaceSettings settings;
  for (std::size_t group = 1; group < fap::kGroupCount; ++group) {
    settings.mask_type[group] = fba::MaskType::all;
  }
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) settings.mask.set(fap);
  settings.send_range = {true, true, true, true};
  for (auto& set : settings.range) set.fill(31);
  fba::Encoder encoder;
  for (const fap::Frame& frame : clip.frames) {
    fba::PlaneInput plane;
    plane.intra = frame.number == 0;
    plane.face = &frame;
    plane.face_settings = &settings;
    if (!encoder.write(plane)) return {};
  }
  return encoder.finish();
}

void count_planes(benchmark::State& state, const fap::Sequence& clip, std::size_t bytes) {
  const double planes = double(clip.frames.size());
  state.counters["planes/s"] =
      benchmark::Counter(planes * double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bits/plane"] = double(bytes) * 8 / planes;
}

void decode_tight(benchmark::State& state) {
  const fap::Sequence clip = moving_face(2000);
  const auto stream = fba::encode(clip);
  for (auto _ : state) benchmark::DoNotOptimize(fba::decode(*stream));
  count_planes(state, clip, stream->size());
}
BENCHMARK(decode_tight)->Unit(benchmark::kMillisecond);

void decode_wide(benchmark::State& state) {
  const fap::Sequence clip = moving_face(2000);
  const auto stream = wide_stream(clip);
  for (auto _ : state) benchmark::DoNotOptimize(fba::decode(stream));
  count_planes(state, clip, stream.size());
}
BENCHMARK(decode_wide)->Unit(benchmark::kMillisecond);

void encode_clip(benchmark::State& state) {
  const fap::Sequence clip = moving_face(2000);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = fba::encode(clip)->size();
  count_planes(state, clip, bytes);
}
BENCHMARK(encode_clip)->Unit(benchmark::kMillisecond);

void read_fap_text(benchmark::State& state) {
  const std::string text = fap::write_text(moving_face(2000));
  for (auto _ : state) benchmark::DoNotOptimize(fap::read_text(text));
  state.SetBytesProcessed(std::int64_t(text.size()) * std::int64_t(state.iterations()));
}
BENCHMARK(read_fap_text)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace animeme
