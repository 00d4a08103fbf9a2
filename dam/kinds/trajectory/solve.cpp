// The trajectory of a control for given Gaussians.
#include <cmath>

#include "dam/kinds/trajectory/fit_control.h"

namespace animeme::dam {
namespace {

/// Precision of points with little speech around them: the ends of a run.
constexpr double kLeastPrecision = 1e-6;

}  // namespace

Trajectory::Trajectory(const Grid& grid, std::size_t order, const Gaussians& gaussians)
    : grid_(grid),
      weight_(std::exp(2 * double(order) * (gaussians.log_smoothness - std::log(kGridStep)))),
      factors_(grid.runs.size()),
      values_(grid.points(), 0.0) {
  std::vector<double> precision(grid.points(), kLeastPrecision);
  std::vector<double> state(gaussians.states());
  for (std::size_t s = 0; s < state.size(); ++s) state[s] = std::exp(gaussians.log_precision[s]);
  for (std::size_t i = 0; i < grid.points(); ++i)
    for (const Cover& cover : grid.at(i)) {
      const double part = cover.share * state[cover.state];
      precision[i] += part;
      values_[i] += part * gaussians.mean[cover.state];
    }
  for (std::size_t r = 0; r < grid.runs.size(); ++r) {
    const Run& run = grid.runs[r];
    factors_[r].factor(std::span(precision).subspan(run.begin, run.points), weight_, order);
  }
  solve(values_);
}

double Trajectory::read(const Reading& reading) const {
  double sum = 0;
  for (std::size_t m = 0; m < 4; ++m) sum += reading.weight[m] * values_[reading.point + m];
  return sum;
}

void Trajectory::solve(std::span<double> x) const {
  for (std::size_t r = 0; r < grid_.runs.size(); ++r)
    factors_[r].solve(x.subspan(grid_.runs[r].begin, grid_.runs[r].points));
}

}  // namespace animeme::dam
