#include "dam/kinds/refined/solve.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace animeme::dam {
namespace {

constexpr double kRidgeFactors[] = {2, 1, 0.5};
/// Error that a larger ridge may cost. Held-out sentences consist of seen words; unseen words need
/// more regularisation than these suggest (dam/measured.md).
constexpr double kFirmer = 1.005;
constexpr double kToChoose = 1e-4;  // accuracy of the solutions that are only compared

}  // namespace

std::vector<double> explained_by(const CurveErrors& errors) {
  std::vector<double> share(errors.error.size(), 0.0);
  for (std::size_t c = 0; c < share.size(); ++c)
    if (errors.energy[c] > 0) share[c] = 1 - errors.error[c] / errors.energy[c];
  return share;
}

RidgeChooser::RidgeChooser(const LowerTriangle& kept, const TermSpace& space,
                           const TermColumns& columns, double wanted, int threads)
    : space_(space),
      columns_(columns),
      factors_(wanted > 0
                   ? std::vector<double>{wanted}
                   : std::vector<double>(std::begin(kRidgeFactors), std::end(kRidgeFactors))),
      // For the middle one, which is near enough to the others.
      solver_(kept, ridge_of(space, columns, factors_[factors_.size() / 2]), threads),
      threads_(threads) {}

double RidgeChooser::choose(const RidgeTrial& trial,
                            const std::function<bool(double)>& go_on) const {
  if (factors_.size() == 1) return factors_[0];
  std::vector<double> error, now(columns_.size * trial.controls, 0.0);
  for (const double factor : factors_) {
    if (go_on && !go_on(double(error.size()) / double(factors_.size()))) return 0;
    now = solution(trial, factor, std::move(now));
    const CurveErrors on_held = trial.errors(now);
    error.push_back(std::accumulate(on_held.error.begin(), on_held.error.end(), 0.0));
  }
  const double most = kFirmer * *std::min_element(error.begin(), error.end());
  const auto first = std::find_if(error.begin(), error.end(), [&](double e) { return e <= most; });
  return factors_[first == error.end() ? 0 : std::size_t(first - error.begin())];
}

std::vector<double> RidgeChooser::explained(const RidgeTrial& trial, double factor) const {
  return explained_by(trial.errors(
      solution(trial, factor, std::vector<double>(columns_.size * trial.controls, 0.0))));
}

std::vector<double> RidgeChooser::solution(const RidgeTrial& trial, double factor,
                                           std::vector<double> start) const {
  const std::vector<double> ridge = ridge_of(space_, columns_, factor);
  if (solver_.solve(ridge, trial.right, trial.controls, kToChoose, start)) return start;
  return solve_curves(trial.gram, trial.right, space_, columns_, trial.controls, factor, threads_);
}

std::vector<double> means_from_rest(std::span<const Control> controls) {
  std::vector<double> means;
  for (const Control& c : controls) means.push_back(c.sd > 0 ? (c.mean - c.rest) / c.sd : 0.0);
  return means;
}

RefinedParameters refined_parameters(const TermSpace& space, const std::vector<double>& curves,
                                     const std::vector<double>& means,
                                     const RefinedOptions& options,
                                     std::vector<PhoneDominance> dominance) {
  RefinedParameters parameters;
  parameters.time_margin = options.time_margin;
  parameters.duration_exponent = options.duration_exponent;
  parameters.dominance = std::move(dominance);
  const std::size_t k = means.size();
  for (std::size_t t = 0; t < kTermCount; ++t) {
    TermTable table;
    table.term = kTermInfo[t].term;
    table.orders = kTermInfo[t].orders;
    table.keys = space.tables[t].keys;
    const std::size_t values = table.keys.size() * table.orders * k;
    const double* from = curves.data() + space.tables[t].first * k;
    for (std::size_t i = 0; i < values; ++i) {
      const bool level = table.term == RefinedTerm::phone && i / k % table.orders == 0;
      table.values.push_back(float(from[i] + (level ? means[i % k] : 0.0)));
    }
    parameters.tables.push_back(std::move(table));
  }
  return parameters;
}

}  // namespace animeme::dam
