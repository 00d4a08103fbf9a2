#include "tests/bench/rank_controls.h"

#include <cstdio>
#include <utility>
#include <vector>

#include "dam/signal/fap_signal.h"
#include "dam/training/train.h"

namespace animeme::bench {
namespace {

/// The sentences with one control.
std::vector<dam::Utterance> with_control(std::span<const dam::Utterance> rows, std::size_t c) {
  std::vector<dam::Utterance> out;
  for (const dam::Utterance& row : rows) {
    dam::Utterance one = row;
    one.signal.names = {row.signal.names[c]};
    one.signal.values.clear();
    for (std::size_t i = 0; i < row.signal.frames(); ++i)
      one.signal.values.push_back(row.signal.at(i, c));
    out.push_back(std::move(one));
  }
  return out;
}

struct Articulator {
  const char* name;
  std::vector<int> faps;
};

const std::vector<Articulator>& articulators() {
  static const std::vector<Articulator> list = {{"jaw", {3}},
                                                {"upper lip", {4, 8, 9, 51, 55, 56}},
                                                {"lower lip", {5, 10, 11, 52, 57, 58}},
                                                {"corners, width", {6, 7, 53, 54}},
                                                {"corners, height", {12, 13, 59, 60}}};
  return list;
}

}  // namespace

Result<dam::Evaluation> evaluate_per_control(const dam::Model& shared,
                                             std::span<const dam::Utterance> train,
                                             std::span<const dam::Utterance> test,
                                             const dam::TrainOptions& options,
                                             const dam::EvaluateOptions& scoring) {
  std::vector<dam::SentencePair> pairs;
  for (const dam::Utterance& row : test) {
    pairs.push_back({row, row.signal});
    for (double& value : pairs.back().synthesised.values) value = 0;
  }
  for (std::size_t c = 0; c < shared.controls.size(); ++c) {
    const auto model = dam::train(with_control(train, c), options);
    if (!model) return model.error();
    dam::EvaluateOptions one = scoring;
    one.synthesis.closure = false;
    const auto made = dam::synthesise_pairs(*model, with_control(test, c), one);
    if (!made) return made.error();
    for (std::size_t s = 0; s < pairs.size(); ++s)
      for (std::size_t i = 0; i < pairs[s].synthesised.frames(); ++i)
        pairs[s].synthesised.at(i, c) = (*made)[s].synthesised.at(i, 0);
  }
  dam::ScoreOptions score = scoring.score;
  score.scale = shared.controls;
  return dam::score(pairs, score);
}

std::string velocity_head() {
  std::string head = "|  | NRMSE", line = "|---|---";
  for (const Articulator& one : articulators()) {
    head += std::string(" | ") + one.name;
    line += "|---";
  }
  return head + " |\n" + line + "|\n";
}

std::string velocity_row(const std::string& name, const dam::Evaluation& evaluation) {
  char text[64];
  std::snprintf(text, sizeof text, " | %.4f", evaluation.nrmse);
  std::string row = "| " + name + text;
  for (const Articulator& articulator : articulators()) {
    double sum = 0, count = 0;
    for (const dam::DynamicsScore& one : evaluation.series_dynamics) {
      if (!one.scored) continue;
      for (const int fap : articulator.faps) {
        if (dam::fap_of_channel(one.name) != fap) continue;
        sum += one.velocity;
        count += 1;
      }
    }
    std::snprintf(text, sizeof text, " | %.2f", count > 0 ? sum / count : 0);
    row += text;
  }
  return row + " |\n";
}

}  // namespace animeme::bench
