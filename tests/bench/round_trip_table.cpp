// Prints how ARKit's weights come back in time through FAPs: from ARKit's tables, and from heads of
// others. A head that lacks shapes of a sequence shows it as it can; then that has to come back.
//   build/release/bin/round_trip_table [SHARED [SECONDS]]
// SHARED: the folder with data/livelink_rom and data/avatars; without it the takes and the avatars
// are left out. Each sequence is at most SECONDS long. Exit code 1 if a row misses a limit.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "fap/head/rig.h"
#include "tests/bench/round_trip_material.h"
#include "tools/view/studio/head_file.h"

namespace {

using namespace animeme;
using bench::Rows;
using bench::WeightSequence;

constexpr double kMostOff = 0.01, kMostOpposites = 0.05, kMostJump = 0.2;

// Something that shows faces by weights.
struct Target {
  std::string name;
  std::vector<std::string> shapes;
  std::vector<std::optional<int>> channels;
  std::function<std::vector<double>(const fap::Frame&)> fit;
  std::function<fap::Frame(const std::vector<double>&)> face;
  std::function<void()> restart;
};

Target tables() {
  Target target{"ARKit's tables", {}, {}, {}, {}, {}};
  for (int c = 0; c < fap::kArkitShapeCount; ++c) {
    target.shapes.emplace_back(fap::kArkitNames[std::size_t(c)]);
    target.channels.emplace_back(c);
  }
  const auto fitter = std::make_shared<fap::ArkitFitter>();
  target.fit = [fitter](const fap::Frame& frame) {
    const fap::ArkitFrame weights = fitter->fit(frame);
    return std::vector<double>(weights.begin(), weights.begin() + fap::kArkitShapeCount);
  };
  target.restart = [fitter] { *fitter = fap::ArkitFitter(); };
  return target;
}

Target head_of(const std::string& name, std::shared_ptr<const head::Rig> rig) {
  Target target{name, {}, {}, {}, {}, [] {}};
  for (const head::ShapeControl& shape : rig->shapes) {
    const bool known = shape.arkit && *shape.arkit >= 0;
    target.shapes.emplace_back(known ? std::string(fap::kArkitNames[std::size_t(*shape.arkit)])
                                     : shape.name);
    target.channels.push_back(known ? shape.arkit : std::nullopt);
  }
  target.fit = [rig](const fap::Frame& frame) {
    const head::ControlValues values = head::control_values(*rig, frame);
    std::vector<double> weights;
    for (std::size_t i = 0; i < rig->shapes.size(); ++i) {
      weights.push_back(double(values[head::kFirstShape + i] / head::kFullShape));
    }
    return weights;
  };
  target.face = [rig](const std::vector<double>& weights) {
    std::array<double, fap::kFapCount + 1> sums{};
    for (std::size_t i = 0; i < weights.size(); ++i) {
      for (std::size_t f = 0; f < sums.size(); ++f) {
        sums[f] += weights[i] * rig->shapes[i].faps.value[f];
      }
    }
    fap::Frame frame;
    for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      frame.set(f, std::int32_t(std::lround(sums[std::size_t(f)])));
    }
    return frame;
  };
  return target;
}

// Whether it has a shape for all that moves.
bool has_all(const Target& target, const WeightSequence& sequence) {
  for (int c = 0; c < fap::kArkitShapeCount; ++c) {
    const bool moves = std::any_of(sequence.frames.begin(), sequence.frames.end(),
                                   [&](const auto& frame) { return frame[std::size_t(c)] > 0.02; });
    const bool has =
        std::find(target.channels.begin(), target.channels.end(), c) != target.channels.end();
    if (moves && !has) return false;
  }
  return true;
}

bool print(const Target& target, const WeightSequence& sequence) {
  const bool as_given = has_all(target, sequence);
  Rows given, found;
  target.restart();
  for (const fap::ArkitFrame& frame : sequence.frames) {
    if (!as_given) {
      given.push_back(target.fit(bench::complete_face(frame)));
      continue;
    }
    given.emplace_back();
    for (const std::optional<int>& channel : target.channels) {
      given.back().push_back(channel ? std::clamp(frame[std::size_t(*channel)], 0.0, 1.0) : 0);
    }
  }
  target.restart();
  for (std::size_t i = 0; i < given.size(); ++i) {
    found.push_back(
        target.fit(as_given ? bench::complete_face(sequence.frames[i]) : target.face(given[i])));
  }
  const bench::Comparison result = bench::compare_weights(given, found, target.shapes);
  const bool ok =
      result.off <= kMostOff && result.opposites <= kMostOpposites && result.jump <= kMostJump;
  std::string where;
  if (result.off > kMostOff) where += ", " + result.off_most;
  if (result.opposites > kMostOpposites) where += ", " + result.opposite_most;
  if (result.jump > kMostJump) where += ", " + result.jumps_most;
  std::printf("| %s | %s | %s | %g | %zu | %.4f | %.2f %% | %.2f | %.2f | %s%s |\n",
              target.name.c_str(), sequence.name.c_str(), as_given ? "given" : "its own",
              sequence.rate, sequence.frames.size(), result.mean, 100 * result.off,
              result.opposites, result.jump, ok ? "ok" : "misses", where.c_str());
  return ok;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path shared = argc > 1 ? argv[1] : "";
  const double seconds = argc > 2 ? std::atof(argv[2]) : 1e6;
  std::vector<Target> targets = {tables()};
  for (const char* name : {"arkit_and_visemes", "brunette-t", "visemes_only", "vroid"}) {
    const auto path = shared / "data" / "avatars" / (std::string(name) + ".glb");
    std::error_code none;
    if (shared.empty() || !std::filesystem::exists(path, none)) continue;
    studio::HeadChoice choice;
    choice.head = path.string();
    const auto loaded = studio::load_head(choice);
    if (!loaded) {
      std::fprintf(stderr, "%s\n", loaded.error().describe().c_str());
      return 3;
    }
    targets.push_back(
        head_of(name, std::make_shared<const head::Rig>(head::make_rig(loaded->head))));
  }
  std::printf(
      "| shown by | sequence | weights | rate | frames | mean difference | frames off by > 0.2 | "
      "opposites | jump beyond the input | |\n|---|---|---|---|---|---|---|---|---|---|\n");
  int missed = 0, rows = 0;
  const std::vector<WeightSequence> sequences = bench::weight_sequences(shared, seconds);
  for (const Target& target : targets) {
    for (const WeightSequence& sequence : sequences) {
      ++rows;
      missed += print(target, sequence) ? 0 : 1;
    }
  }
  std::printf("\n%d of %d rows miss a limit (%g %% of frames, opposites %g, jump %g)\n", missed,
              rows, 100 * kMostOff, kMostOpposites, kMostJump);
  return missed == 0 ? 0 : 1;
}
