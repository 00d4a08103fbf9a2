#include <algorithm>
#include <vector>

#include "dam/detail/fit.h"

namespace animeme::dam {

double estimate_lag(FitData data, const FitWeights& weights, const FitState& state) {
  constexpr int kSteps = 3;
  constexpr double kStep = 0.040;
  std::vector<double> objective;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double shift = i == -kSteps ? -kSteps * kStep : kStep;  // from the last place
    for (FitOccurrence& o : data.occurrences) o.start += shift;
    FitState trial;
    trial.sigma = state.sigma;
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

}  // namespace animeme::dam
