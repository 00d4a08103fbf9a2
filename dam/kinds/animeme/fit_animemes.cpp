#include <algorithm>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/animeme/contexts.h"
#include "dam/kinds/animeme/fit.h"
#include "dam/kinds/animeme/modes.h"

namespace animeme::dam {
namespace {

void store_modes(const FitData& data, const FitState& state, const ModeTable& table,
                 std::vector<AnimemePhone>& phones) {
  const std::size_t k = data.controls, terms = data.terms();
  std::vector<double> series(terms);
  for (std::size_t p = 0; p < phones.size(); ++p)
    for (std::size_t g = 0; g < phones[p].modes.size(); ++g) {
      const std::size_t mode = table.first[p] + g;
      Mode& out = phones[p].modes[g];
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

class AnimemeTrainer {
 public:
  AnimemeTrainer(FitData data, const Model& model, const AnimemeOptions& own,
                 const TrainOptions& options, TrainRun& run)
      : data_(std::move(data)),
        own_(own),
        options_(options),
        run_(run),
        weights_{own.ridge, own.width_prior, options.threads},
        classes_(context_classes(model)),
        phones_(model.phones.size()) {}

  Result<Parameters> fit() {
    TrainSummary& summary = run_.summary;
    if (!run_.report("modes", 0)) return TrainRun::cancelled();
    const ModeTable table = find_modes(data_, phones_.size(), own_, options_.threads);
    count_contexts(data_, table, phones_);
    FitState state;
    state.sigma.assign(table.count(), 1.0);
    solve_coefficients(data_, weights_, state);
    if (!settle_modes(table, state)) return TrainRun::cancelled();
    summary.objective.push_back(state.objective);
    bool go_on = true;
    summary.converged = expectation_maximisation(
        data_, weights_, options_.max_iterations, options_.tolerance, state,
        [&](const FitState& now) {
          summary.objective.push_back(now.objective);
          go_on =
              run_.report("fit", double(summary.objective.size()) / (options_.max_iterations + 1),
                          now.objective);
          return go_on;
        });
    if (!go_on) return TrainRun::cancelled();
    summary.modes = table.count();
    store_modes(data_, state, table, phones_);
    AnimemeParameters parameters;
    parameters.order = std::uint32_t(data_.order);
    parameters.normalised = data_.normalised;
    parameters.time_margin = data_.time_margin;
    parameters.phones = std::move(phones_);
    return Parameters(std::move(parameters));
  }

 private:
  /// Clusters come from the signal over the phone alone. Moving occurrences to the mode that
  /// explains the whole signal, neighbours included, and that its context predicts, makes them
  /// modes of the model. Done before the objective is followed: it changes the problem.
  bool settle_modes(const ModeTable& table, FitState& state) {
    const double context_weight = own_.context_weight * double(data_.controls);
    const bool several = table.count() > phones_.size();
    for (int round = 0; several && round < own_.reassign_rounds; ++round) {
      expectation_maximisation(data_, weights_, 2, options_.tolerance, state,
                               [](const FitState&) { return true; });
      if (!run_.report("modes", (round + 1.0) / own_.reassign_rounds, state.objective))
        return false;
      std::vector<std::size_t>& moved = run_.summary.moved;
      moved.push_back(reassign_modes(data_, table, state, context_weight, classes_, phones_));
      if (moved.back() == 0) break;
      solve_coefficients(data_, weights_, state);
    }
    return true;
  }

  FitData data_;
  const AnimemeOptions& own_;
  const TrainOptions& options_;
  TrainRun& run_;
  FitWeights weights_;
  std::vector<std::uint32_t> classes_;
  std::vector<AnimemePhone> phones_;
};

}  // namespace

Result<Parameters> fit_animemes(const TrainingSet& set, const Model& model,
                                const TrainOptions& options, TrainRun& run) {
  AnimemeOptions own = options.animeme;
  if (model.method == Method::cohen_massaro) {
    own.order = 0;
    own.modes = false;
  }
  FitData data{set.data};
  data.order = own.order;
  data.time_margin = own.time_margin;
  data.normalised = own.normalised;
  return AnimemeTrainer(std::move(data), model, own, options, run).fit();
}

}  // namespace animeme::dam
