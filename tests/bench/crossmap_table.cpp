// Prints the tables of tools/characters/crossmap/README.md: grid_s1/lips by key shapes to FAPs, to
// ARKit's shapes and to the mesh of ICT-FaceKit, beside the FAPs that were measured on the same
// points. Key shapes are those of every other sentence; the rest is scored.
//   build/release/bin/crossmap_table SHARED_DATA [--swap]   (the folder with grid_s1 and
//   ict_facekit; the halves change places)
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "dam/corpus/corpus.h"
#include "dam/evaluation/evaluate.h"
#include "dam/signal/fap_signal.h"
#include "tests/support/temp_dir.h"
#include "tools/characters/crossmap/run.h"

namespace {

using namespace animeme;
namespace fs = std::filesystem;
using crossmap::Project;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().describe().c_str());
  std::exit(1);
}

void unpack(const fs::path& from, const fs::path& to) {
  gzFile in = gzopen(from.c_str(), "rb");
  std::ofstream out(to, std::ios::binary);
  char buffer[65536];
  for (int got = 0; in != nullptr && (got = gzread(in, buffer, sizeof buffer)) > 0;) {
    out.write(buffer, got);
  }
  if (in != nullptr) gzclose(in);
}

struct Halves {
  Project search, fit;                   // inputs of the two
  std::vector<dam::Utterance> measured;  // of the second
};

Halves read_halves(const fs::path& grid, bool swap) {
  Halves out;
  dam::Corpus corpus = need(dam::read_corpus(grid));
  std::sort(corpus.utterances.begin(), corpus.utterances.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  bool first = swap;
  for (dam::Utterance& utterance : corpus.utterances) {
    const fs::path lips = grid / "lips" / (utterance.id + ".csv");
    if (!fs::exists(lips)) continue;
    first = !first;
    (first ? out.search : out.fit).inputs.push_back(lips.string());
    if (!first) out.measured.push_back(std::move(utterance));
  }
  out.search.neutral = out.fit.neutral = (grid / "neutral.json").string();
  return out;
}

// What a face would show: FAPs of the points, by the FAPs of the controls.
dam::Signal shown(const crossmap::Target& target, const dam::Signal& made,
                  const std::vector<int>& faps) {
  dam::Signal out{made.rate, 0, {}, {}, {}};
  for (const int fap : faps) out.names.push_back(dam::fap_channel(fap));
  for (std::size_t i = 0; i < made.frames(); ++i) {
    std::vector<double> values(69, 0.0);
    const double* controls = &made.values[i * made.names.size()];
    if (target.mesh) {
      for (std::size_t c = 0; c < made.names.size(); ++c) {
        const fap::Frame& full = target.mesh->controls[c].faps;
        for (std::size_t f = 3; f < 69; ++f) values[f] += controls[c] * full.value[f];
      }
    } else {
      const auto frame = crossmap::shown_faps(target, controls);
      for (std::size_t f = 3; f < 69; ++f) values[f] = frame->value[f];
    }
    for (const int fap : faps) out.values.push_back(values[std::size_t(fap)]);
  }
  return out;
}

struct Scored {
  dam::Evaluation evaluation;
  double residual = 0, seconds = 0;
  std::size_t keys = 0, controls = 0;
};

Scored run(const Halves& halves, const Project& changes) {
  Project search = changes, fit = changes;
  search.inputs = halves.search.inputs;
  fit.inputs = halves.fit.inputs;
  search.neutral = fit.neutral = halves.fit.neutral;
  const auto first = need(crossmap::load_capture(search, {}));
  const auto keys = need(crossmap::load_keys(search, first, {}));
  const auto second = need(crossmap::load_capture(fit, {}));
  const auto target = need(crossmap::load_target(fit, second, keys, {}));
  Scored out;
  out.keys = keys.shapes.names.size();
  out.controls = target.character.controls.size();
  std::vector<dam::SentencePair> pairs;
  std::vector<const dam::Utterance*> recorded;
  for (std::size_t i = 0; i < second.tracks.size(); ++i) {
    const auto blend =
        need(dam::fit_blend(second.tracks[i], keys.shapes, second.regions, second.fit));
    out.residual += blend.residual / double(second.tracks.size());
    const auto made =
        need(crossmap::fit_target(target, blend, second.tracks[i].rate, fit.controls_fit));
    pairs.push_back({halves.measured[i], shown(target, made.signal, second.face->faps)});
    recorded.push_back(&halves.measured[i]);
  }
  dam::ScoreOptions options;
  const auto& names = pairs[0].synthesised.names;
  for (dam::Control& control : dam::recording_scale(recorded)) {
    if (std::find(names.begin(), names.end(), control.name) != names.end()) {
      options.scale.push_back(control);
    }
  }
  out.evaluation = need(dam::score(pairs, options));
  return out;
}

void print_row(const char* name, const Scored& scored) {
  double squares = 0, count = 0;
  for (const dam::SeriesScore& series : scored.evaluation.controls) {
    if (!series.scored) continue;
    squares += series.rmse * series.rmse;
    ++count;
  }
  const dam::ClosureScore& closure = scored.evaluation.closure;
  std::printf("| %s | %zu | %zu | %.2f | %.1f | %.3f | %.1f %% (%.1f %%) |\n", name, scored.keys,
              scored.controls, scored.residual, std::sqrt(squares / count),
              scored.evaluation.correlation, 100 * closure.predicted, 100 * closure.measured);
}

}  // namespace

int main(int argc, char** argv) {
  const bool swap = argc == 3 && std::string_view(argv[2]) == "--swap";
  if (argc != 2 && !swap) {
    std::fputs("usage: crossmap_table SHARED_DATA [--swap]\n", stderr);
    return 2;
  }
  const fs::path data = argv[1];
  const Halves halves = read_halves(data / "grid_s1", swap);
  std::printf("%zu sentences for key shapes, %zu scored\n\n", halves.search.inputs.size(),
              halves.fit.inputs.size());
  std::printf(
      "| target | key shapes | controls | residual, px | RMS, FAP units | correlation | closed "
      "(measured) |\n|---|---|---|---|---|---|---|\n");
  Project project;
  const Scored faps = run(halves, project);
  print_row("FAPs", faps);
  for (const std::size_t count : {6, 10, 14, 30}) {
    Project some = project;
    some.search.count = count;
    print_row("FAPs", run(halves, some));
  }
  Project other = project;
  other.fit.contact_weight = 0;
  print_row("FAPs, no contacts", run(halves, other));
  other = project;
  other.fit.convex = true;
  print_row("FAPs, convex", run(halves, other));
  other = project;
  other.fit.smooth = 0.04;
  print_row("FAPs, smoothed by 40 ms", run(halves, other));
  other = project;
  other.to = "arkit";
  print_row("ARKit's shapes", run(halves, other));
  const fs::path ict = data / "ict_facekit";
  if (fs::exists(ict / "jawOpen.obj.gz")) {
    const test::TempDir folder;
    const auto file = [&](const std::string& name) {
      unpack(ict / (name + ".obj.gz"), folder / (name + ".obj"));
      return folder / (name + ".obj");
    };
    other.to = file("generic_neutral_mesh");
    other.head_points = (ict / "ict_feature_points.csv").string();
    for (const char* name :
         {"jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthSmile_L", "mouthSmile_R"}) {
      other.shapes.push_back(file(name));
    }
    print_row("ICT-FaceKit, six shapes as meshes", run(halves, other));
  }
  std::printf("\n| FAP | RMS | correlation |\n|---|---|---|\n");
  for (const dam::SeriesScore& series : faps.evaluation.controls) {
    if (series.scored) {
      std::printf("| %s | %.1f | %.3f |\n", series.name.c_str(), series.rmse, series.correlation);
    }
  }
}
