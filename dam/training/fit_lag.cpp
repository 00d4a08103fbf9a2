#include "dam/training/fit_lag_internal.h"

#include <algorithm>
#include <vector>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/animeme/fit.h"

namespace animeme::dam {

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

}  // namespace animeme::dam
