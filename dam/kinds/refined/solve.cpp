#include "dam/kinds/refined/solve.h"

#include <algorithm>
#include <numeric>

namespace animeme::dam {
namespace {

constexpr double kRidgeFactors[] = {2, 1, 0.5};
/// Error that a larger ridge may cost. Held-out sentences consist of seen words; unseen words need
/// more regularisation than these suggest (dam/measured.md).
constexpr double kFirmer = 1.005;

}  // namespace

std::vector<double> explained_by(const CurveSums& sums, const std::vector<double>& errors) {
  std::vector<double> share(errors.size(), 0.0);
  for (std::size_t c = 0; c < share.size(); ++c)
    if (sums.energy[c] > 0) share[c] = 1 - errors[c] / sums.energy[c];
  return share;
}

RidgeChoice choose_ridge(const CurveSums& kept, const CurveSums& held, const TermSpace& space,
                         std::size_t controls, double wanted, int threads, SquareMatrix& work,
                         const std::function<bool(double)>& go_on) {
  const std::span<const double> factors =
      wanted > 0 ? std::span<const double>(&wanted, 1) : std::span<const double>(kRidgeFactors);
  std::vector<RidgeChoice> choices;
  std::vector<double> error;
  for (const double factor : factors) {
    if (go_on && !go_on(double(error.size()) / double(factors.size()))) return {};
    const auto curves = solve_curves(kept, space, controls, factor, threads, work);
    const auto errors = errors_of(held, curves, controls);
    error.push_back(std::accumulate(errors.begin(), errors.end(), 0.0));
    choices.push_back({factor, explained_by(held, errors)});
  }
  const double most = kFirmer * *std::min_element(error.begin(), error.end());
  const auto first = std::find_if(error.begin(), error.end(), [&](double e) { return e <= most; });
  return choices[first == error.end() ? 0 : std::size_t(first - error.begin())];
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
