#include "dam/train.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dam/detail/fit.h"
#include "dam/detail/modes.h"
#include "dam/detail/training_set.h"

namespace animeme::dam {
namespace {

constexpr double kNotableLag = 0.050;  // seconds

struct Range {
  const char* name;
  double value, low, high;
};

/// Sentences by their identifiers: the order in which they are given must not matter.
std::vector<const Utterance*> sorted(std::span<const Utterance> utterances) {
  std::vector<const Utterance*> list;
  for (const Utterance& u : utterances) list.push_back(&u);
  std::stable_sort(list.begin(), list.end(),
                   [](const Utterance* a, const Utterance* b) { return a->id < b->id; });
  return list;
}

void store_modes(const FitData& data, const FitState& state, const ModeTable& table, Model& model) {
  const std::size_t k = data.controls, terms = data.terms();
  std::vector<double> series(terms);
  for (std::size_t p = 0; p < model.phones.size(); ++p)
    for (std::size_t g = 0; g < model.phones[p].modes.size(); ++g) {
      const std::size_t mode = table.first[p] + g;
      Mode& out = model.phones[p].modes[g];
      out.sigma = state.sigma[mode];
      out.coefficients.resize(terms * k);
      for (std::size_t c = 0; c < k; ++c) {
        for (std::size_t m = 0; m < terms; ++m)
          series[m] = state.coefficients[(mode * terms + m) * k + c];
        const std::vector<double> powers = power_coefficients(series);
        for (std::size_t m = 0; m < terms; ++m) out.coefficients[m * k + c] = powers[m];
      }
    }
}

class Trainer {
 public:
  Trainer(TrainingSet set, const TrainOptions& options, const ProgressFunction& progress)
      : set_(std::move(set)),
        options_(options),
        progress_(progress),
        weights_{options.ridge, options.width_prior, options.threads} {}

  Result<Model> run(TrainSummary& summary) {
    if (!report("modes", 0, 0)) return cancelled();
    const ModeTable table = find_modes(set_.data, set_.phones.size(), options_);
    count_contexts(set_.data, table, set_.phones);
    FitState state;
    state.sigma.assign(table.count(), 1.0);
    solve_coefficients(set_.data, weights_, state);
    if (!settle_modes(table, state, summary)) return cancelled();
    summary.objective.push_back(state.objective);
    bool go_on = true;
    summary.converged = expectation_maximisation(
        set_.data, weights_, options_.max_iterations, options_.tolerance, state,
        [&](const FitState& now) {
          summary.objective.push_back(now.objective);
          go_on = report("fit", double(summary.objective.size()) / (options_.max_iterations + 1),
                         now.objective);
          return go_on;
        });
    if (!go_on) return cancelled();
    return finish(table, state, summary);
  }

 private:
  static Error cancelled() { return make_error(Code::invalid_argument, "training was cancelled"); }

  bool report(const char* stage, double done, double objective) const {
    return !progress_ || progress_(Progress{stage, done, objective});
  }

  /// Clusters come from the signal over the phone alone. Moving occurrences to the mode that
  /// explains the whole signal, neighbours included, and that its context predicts, makes them
  /// modes of the model. Done before the objective is followed: it changes the problem.
  bool settle_modes(const ModeTable& table, FitState& state, TrainSummary& summary) {
    const double context_weight = options_.context_weight * double(set_.data.controls);
    const bool several = table.count() > set_.phones.size();
    for (int round = 0; several && round < options_.reassign_rounds; ++round) {
      expectation_maximisation(set_.data, weights_, 2, options_.tolerance, state,
                               [](const FitState&) { return true; });
      if (!report("modes", (round + 1.0) / options_.reassign_rounds, state.objective)) return false;
      summary.moved.push_back(reassign_modes(set_.data, table, state, context_weight, set_.phones));
      if (summary.moved.back() == 0) break;
      solve_coefficients(set_.data, weights_, state);
    }
    return true;
  }

  Model finish(const ModeTable& table, const FitState& state, TrainSummary& summary) {
    Model model;
    model.method = options_.method;
    model.order = std::uint32_t(options_.order);
    model.time_margin = options_.time_margin;
    model.normalised = options_.normalised;
    model.pause_edge = options_.pause_edge;
    model.closure_gap = set_.closure_gap;
    model.rate = set_.rate;
    model.attribution = options_.attribution;
    model.provenance = options_.provenance;
    model.controls = std::move(set_.controls);
    model.phones = std::move(set_.phones);
    store_modes(set_.data, state, table, model);
    summary.iterations = int(summary.objective.size()) - 1;
    summary.utterances = set_.data.sentences.size();
    summary.frames = std::size_t(std::count(set_.data.use.begin(), set_.data.use.end(), 1));
    summary.occurrences = set_.data.occurrences.size();
    summary.modes = table.count();
    for (const PhoneModel& phone : model.phones)
      summary.modes_per_phone.emplace_back(phone.label, phone.modes.size());
    summary.warnings = std::move(set_.warnings);
    summary.lag = estimate_lag(set_.data, weights_, state);
    if (std::abs(summary.lag) > kNotableLag)
      summary.warnings.push_back("the signal comes about " +
                                 std::to_string(std::lround(summary.lag * 1000)) +
                                 " ms after the phonemes; check the alignment of the corpus");
    return model;
  }

  TrainingSet set_;
  const TrainOptions& options_;
  const ProgressFunction& progress_;
  FitWeights weights_;
};

}  // namespace

Result<void> validate(const TrainOptions& o) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Range ranges[] = {
      {"order", double(o.order), 0, kMaxOrder},
      {"resample_points", double(o.resample_points), 2, 32},
      {"preference", o.preference, 0.1, 100},
      {"damping", o.damping, 0.5, 0.99},
      {"affinity_iterations", double(o.affinity_iterations), 1, 10000},
      {"affinity_limit", double(o.affinity_limit), 2, 5000},
      {"mode_examples", double(o.mode_examples), 1, 1e6},
      {"reassign_rounds", double(o.reassign_rounds), 0, 100},
      {"context_weight", o.context_weight, 0, 1e6},
      {"ridge", o.ridge, 0, 1e6},
      {"width_prior", o.width_prior, 0, 1e6},
      {"time_margin", o.time_margin, 0, infinity},
      {"max_iterations", double(o.max_iterations), 0, 1000},
      {"tolerance", o.tolerance, 0, 1},
      {"pause_edge", o.pause_edge, 0.05, 5},
      {"threads", double(o.threads), 0, 1024},
  };
  for (const Range& r : ranges)
    if (!(r.value >= r.low && r.value <= r.high))
      return make_error(Code::invalid_argument, std::string("training option ") + r.name +
                                                    " must lie between " + std::to_string(r.low) +
                                                    " and " + std::to_string(r.high));
  if (o.method != Method::dam_paper)
    return make_error(Code::unsupported, "this version trains the method dam-paper only");
  return {};
}

Result<Model> train(std::span<const Utterance> utterances, const TrainOptions& options,
                    TrainSummary* summary, const ProgressFunction& progress) {
  const auto begin = std::chrono::steady_clock::now();
  if (auto ok = validate(options); !ok) return ok.error();
  auto set = make_training_set(sorted(utterances), options);
  if (!set) return set.error();
  TrainSummary own;
  TrainSummary& out = summary != nullptr ? *summary : own;
  out = {};
  auto model = Trainer(std::move(*set), options, progress).run(out);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return model;
}

}  // namespace animeme::dam
