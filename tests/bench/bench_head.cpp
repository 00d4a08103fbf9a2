// Speed of heads: making, rigging, posing and drawing them. `frame` is a pose and its picture of
// 640x640 pixels with the threads of its argument; frames/s counts wall
// time, the column CPU is that of all threads together.
#include <benchmark/benchmark.h>

#include <cmath>

#include "fap/arkit.h"
#include "fap/head/rig.h"
#include "tools/view/render/scene.h"

namespace animeme::bench {
namespace {

struct Ready {
  head::Head head = *head::make_head();
  head::Rig rig = head::make_rig(head);
};

const Ready& ready() {
  static const Ready r;
  return r;
}

// Speech with gaze and nods: no frame is like the one before.
fap::Frame speaking(int i) {
  fap::Frame frame;
  frame.mask.set(1);
  frame.viseme = {1 + i % 14, 1 + i / 3 % 14, i * 7 % 64, false};
  frame.set(19, i % 12 * 80);
  frame.set(20, i % 12 * 80);
  frame.set(23, i % 40 * 300);
  frame.set(24, i % 40 * 300);
  frame.set(33, i % 30 * 8);
  frame.set(48, i % 25 * 500);
  frame.set(49, i % 60 * 300);
  return frame;
}

void make(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(head::make_head());
}

void rig(benchmark::State& state) {
  const head::Head& head = ready().head;
  for (auto _ : state) benchmark::DoNotOptimize(head::make_rig(head));
}

void pose(benchmark::State& state) {
  const head::Rig& rig = ready().rig;
  head::Pose out;
  int i = 0;
  for (auto _ : state) {
    head::pose(rig, speaking(i++), out);
    benchmark::DoNotOptimize(out);
  }
  state.counters["vertices"] = double(ready().head.part(head::Part::skin).positions.size());
}

// What a head with ARKit's 52 shapes costs beyond its targets: the weights that fit a frame.
void shape_weights(benchmark::State& state) {
  head::Rig rig;
  rig.fapu = ready().rig.fapu;
  for (std::size_t shape = 0; shape < fap::kArkitShapeCount; ++shape) {
    fap::ArkitFrame weights{};
    weights[shape] = 1;
    rig.shapes.push_back({std::string(fap::kArkitNames[shape]),
                          fap::arkit_to_fap(weights, fap::kAllArkit), int(shape)});
  }
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(head::control_values(rig, speaking(i++)));
}

void frame(benchmark::State& state) {
  const Ready& r = ready();
  render::Renderer renderer({.width = 640, .height = 640, .threads = int(state.range(0))});
  const render::Camera camera = render::look_at(r.head, 0);
  head::Pose out;
  int i = 0;
  for (auto _ : state) {
    head::pose(r.rig, speaking(i++), out);
    benchmark::DoNotOptimize(renderer.render(render::scene_of(r.head, r.rig, out), camera));
  }
  std::size_t triangles = 0;
  for (const head::Mesh& mesh : r.head.parts) triangles += mesh.triangles.size();
  state.counters["triangles"] = double(triangles);
  state.counters["frames/s"] =
      benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(make)->Unit(benchmark::kMillisecond);
BENCHMARK(rig)->Unit(benchmark::kMillisecond);
BENCHMARK(pose)->Unit(benchmark::kMillisecond);
BENCHMARK(shape_weights)->Unit(benchmark::kMillisecond);
BENCHMARK(frame)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace animeme::bench
