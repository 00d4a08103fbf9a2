// Prints the tables of dam/crossmap/README.md: grid_s1/lips by key shapes to FAPs and to the shapes of ARKit, beside
// the FAPs that were measured on the same points. Key shapes are those of every other sentence; the rest is scored.
//   build/release/bin/crossmap_table FOLDER_OF_GRID_S1
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "dam/corpus/corpus.h"
#include "dam/crossmap/face_points.h"
#include "dam/crossmap/key_shapes.h"
#include "dam/crossmap/retarget.h"
#include "dam/evaluation/evaluate.h"
#include "dam/script/script.h"
#include "dam/signal/fap_signal.h"
#include "fap/arkit.h"
#include "tests/support/files.h"
#include "tools/exchange/points.h"

namespace {

using namespace animeme;
using namespace animeme::dam;
namespace fs = std::filesystem;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().describe().c_str());
  std::exit(1);
}

struct Material {
  std::vector<PointTrack> tracks;  // displacements
  std::vector<Utterance> measured;
  Face face;
  std::vector<Contact> contacts;
};

Material read(const fs::path& folder) {
  Material out;
  Corpus corpus = need(read_corpus(folder, {.split_value = ""}));
  for (Utterance& utterance : corpus.utterances) {
    const fs::path lips = folder / "lips" / (utterance.id + ".csv");
    if (!fs::exists(lips)) continue;
    out.tracks.push_back(need(exchange::read_point_table(test::slurp(lips.string()))).track);
    out.tracks.back().name = utterance.id;
    out.measured.push_back(std::move(utterance));
  }
  const auto json = nlohmann::json::parse(test::slurp((folder / "neutral.json").string()));
  const auto& names = out.tracks.front().names;
  std::vector<double> neutral;
  for (const std::string& name : names) {
    for (std::size_t k = 0; k < 2; ++k) neutral.push_back(json["neutral_px"][name][k]);
  }
  const auto& px = json["fapu_px"];
  FaceOptions options;
  options.fapu = {px["IRISD"], px["ES"], px["ENS"], px["MNS"], px["MW"]};
  const auto points = face_points(names);
  out.face = need(make_face(names, 2, neutral, points, options));
  out.contacts = lip_contacts(points);
  for (PointTrack& track : out.tracks) subtract(track, neutral);
  return out;
}

KeyShapes keys_of(const Material& material, const KeyShapeOptions& options, KeyFrames& found) {
  std::vector<PointTrack> half;
  for (std::size_t i = 0; i < material.tracks.size(); i += 2) half.push_back(material.tracks[i]);
  found = need(find_key_frames(half, {}, options));
  KeyShapes keys;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    const auto shape = half[found.keys[k].track].frame(found.keys[k].frame);
    keys.names.push_back("key" + std::to_string(k + 1));
    keys.values.insert(keys.values.end(), shape.begin(), shape.end());
  }
  return keys;
}

Character faps_of(const Material& material, const KeyShapes& keys) {
  Character out;
  const std::size_t count = material.face.faps.size();
  out.rows = count;
  out.moves.assign(count * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    out.controls.push_back(fap_channel(material.face.faps[i]));
    out.lows.push_back(-2000);
    out.highs.push_back(2000);
    out.moves[i * count + i] = 1;
  }
  const std::size_t size = keys.values.size() / keys.names.size();
  for (std::size_t k = 0; k < keys.names.size(); ++k) {
    const auto values = fap_values(material.face, {&keys.values[k * size], size});
    out.keys.insert(out.keys.end(), values.begin(), values.end());
  }
  return out;
}

void row(const char* name, const Evaluation& e, double residual, std::size_t keys) {
  double rms = 0;
  std::size_t count = 0;
  for (const SeriesScore& s : e.controls) {
    if (!s.scored) continue;
    rms += s.rmse * s.rmse;
    ++count;
  }
  std::printf("| %s | %zu | %.2f | %.1f | %.3f | %.1f %% of %.1f %% |\n", name, keys, residual,
              std::sqrt(rms / double(count)), e.correlation, 100 * e.closure.predicted,
              100 * e.closure.measured);
}

Evaluation run(const Material& material, const KeyShapes& keys, const BlendOptions& options,
               double& residual) {
  const Character character = faps_of(material, keys);
  std::vector<SentencePair> pairs;
  residual = 0;
  for (std::size_t i = 1; i < material.tracks.size(); i += 2) {
    const Blend blend = need(fit_blend(material.tracks[i], keys, {}, options));
    residual += blend.residual / double(material.tracks.size() / 2);
    const Retarget made =
        need(fit_controls(blend, material.tracks[i].rate, character, {.ridge = 0}));
    pairs.push_back({material.measured[i], made.signal});
  }
  std::vector<const Utterance*> all;
  for (const auto& p : pairs) all.push_back(&p.recorded);
  ScoreOptions score_options;
  for (Control& c : recording_scale(all)) {
    if (std::find(character.controls.begin(), character.controls.end(), c.name) !=
        character.controls.end()) {
      score_options.scale.push_back(c);
    }
  }
  return need(score(pairs, score_options));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const Material material = read(argv[1]);
  std::printf("%zu sentences, %zu FAPs\n", material.tracks.size(), material.face.faps.size());
  for (const std::size_t count : {0, 6, 10, 14, 20, 30}) {
    KeyFrames found;
    const KeyShapes keys = keys_of(material, {.count = count}, found);
    for (int variant = 0; variant < 4; ++variant) {
      BlendOptions options;
      options.convex = variant >= 2;
      if (variant % 2) options.contacts = material.contacts;
      double residual = 0;
      const Evaluation e = run(material, keys, options, residual);
      const char* names[] = {"free", "free, contacts", "convex", "convex, contacts"};
      row(names[variant], e, residual, keys.names.size());
    }
  }
}
