#include "dam/training/train.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/animeme/fit.h"
#include "dam/model/kind_internal.h"
#include "dam/training/train_notes_internal.h"

namespace animeme::dam {
namespace {

/// Sentences by their identifiers: the order in which they are given must not matter.
std::vector<const Utterance*> sorted(std::span<const Utterance> utterances) {
  std::vector<const Utterance*> list;
  for (const Utterance& u : utterances) list.push_back(&u);
  std::stable_sort(list.begin(), list.end(),
                   [](const Utterance* a, const Utterance* b) { return a->id < b->id; });
  return list;
}

/// Seconds by which the signal comes after its labels (negative: before), from how well phones fit
/// when all are moved by -120 to 120 ms. Rough: widths and neighbours take up a part of a true lag.
/// `phones` is the number of phones that occurrences refer to.
double estimate_lag(const SpeechData& speech, std::size_t phones, int threads) {
  constexpr int kSteps = 3;
  constexpr double kStep = 0.040;
  FitData data{speech};  // one animeme a phone, with widths as wide as the phones are long
  data.normalised = true;
  for (FitOccurrence& o : data.occurrences) o.mode = std::uint32_t(o.phone);
  FitWeights weights;
  weights.threads = threads;
  std::vector<double> objective;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double shift = i == -kSteps ? -kSteps * kStep : kStep;  // from the last place
    for (FitOccurrence& o : data.occurrences) o.start += shift;
    FitState trial;
    trial.sigma.assign(phones, 1.0);
    solve_coefficients(data, weights, trial);
    objective.push_back(trial.objective);
  }
  const auto best =
      std::size_t(std::min_element(objective.begin(), objective.end()) - objective.begin());
  double lag = (double(best) - kSteps) * kStep;
  if (best > 0 && best + 1 < objective.size()) {  // vertex of the parabola through three points
    const double before = objective[best - 1], after = objective[best + 1];
    const double bend = before + after - 2 * objective[best];
    if (bend > 0) lag += kStep * 0.5 * (before - after) / bend;
  }
  return lag;
}

void summarise(const TrainingSet& set, int threads, TrainSummary& summary) {
  summary.iterations = std::max(0, int(summary.objective.size()) - 1);
  summary.utterances = set.data.sentences.size();
  summary.frames = std::size_t(std::count(set.data.use.begin(), set.data.use.end(), 1));
  summary.occurrences = set.data.occurrences.size();
  summary.lag = estimate_lag(set.data, set.phones.size(), threads);
}

}  // namespace

Result<Model> train(std::span<const Utterance> utterances, const TrainOptions& options,
                    TrainSummary* summary, const ProgressFunction& progress) {
  const auto begin = std::chrono::steady_clock::now();
  if (auto ok = validate(options); !ok) return ok.error();
  const auto sentences = sorted(utterances);
  auto set = make_training_set(sentences, options);
  if (!set) return set.error();
  TrainSummary own;
  TrainSummary& out = summary != nullptr ? *summary : own;
  out = {};
  TrainRun run{out, progress};
  Model model;
  model.method = options.method;
  model.pause_edge = options.pause_edge;
  model.closure_gap = set->closure_gap;
  model.lip_tooth_raise = set->lip_tooth_raise;
  model.shut = set->shut;
  model.rate = set->rate;
  model.attribution = options.attribution;
  model.provenance = options.provenance;
  model.controls = set->controls;
  model.limits = control_limits(sentences, model.controls);
  model.phones = set->phones;
  auto parameters = kind_of(options.method).fit(*set, model, options, run);
  if (!parameters) return parameters.error();
  model.parameters = std::move(*parameters);
  summarise(*set, options.threads, out);
  review_sentences(*set, model, sentences, options.threads, out);
  note_phones(model, out);
  add_warnings(out);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return model;
}

}  // namespace animeme::dam
