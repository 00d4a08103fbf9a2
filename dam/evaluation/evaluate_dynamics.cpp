// Is the motion as lively as the recorded one? Over-smoothing shows as ratios below 1.
#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"

namespace animeme::dam {
namespace {

constexpr double kLowShare = 0.05, kHighShare = 0.95;

double range_ratio(std::vector<double>& made, std::vector<double>& recorded) {
  const double a = percentile(made, kHighShare) - percentile(made, kLowShare);
  const double b = percentile(recorded, kHighShare) - percentile(recorded, kLowShare);
  return b > 0 ? a / b : 0;
}

DynamicsScore score_series(const Layout& layout, const AllSeries& all, std::size_t series) {
  Comparison sums[4];  // by order
  std::vector<double> made, recorded;
  for (const PairSeries& pair : all) {
    const auto& a = pair.made[series];
    const auto& b = pair.recorded[series];
    for (const FrameRun& run : frame_runs(pair.speech)) {
      made.insert(made.end(), a.begin() + std::ptrdiff_t(run.begin),
                  a.begin() + std::ptrdiff_t(run.end));
      recorded.insert(recorded.end(), b.begin() + std::ptrdiff_t(run.begin),
                      b.begin() + std::ptrdiff_t(run.end));
      for (const int order : {1, 2, 3})
        for (std::size_t i = run.begin + kReach[order]; i + kReach[order] < run.end; ++i)
          sums[order].add(derivative(a, i, order), derivative(b, i, order));
    }
  }
  return {layout.name(series),       layout.is_scored(series),  sums[1].deviation_ratio(),
          sums[2].deviation_ratio(), sums[3].deviation_ratio(), range_ratio(made, recorded),
          sums[1].correlation()};
}

}  // namespace

void score_dynamics(const Layout& layout, const AllSeries& all, Evaluation& result) {
  double n = 0;
  DynamicsScore mean{"mean", true, 0, 0, 0, 0, 0};
  for (std::size_t s = 0; s < layout.series(); ++s) {
    const DynamicsScore one = score_series(layout, all, s);
    result.series_dynamics.push_back(one);
    if (!one.scored) continue;
    n += 1;
    mean.velocity += one.velocity;
    mean.acceleration += one.acceleration;
    mean.jerk += one.jerk;
    mean.range += one.range;
    mean.velocity_correlation += one.velocity_correlation;
  }
  for (double* value :
       {&mean.velocity, &mean.acceleration, &mean.jerk, &mean.range, &mean.velocity_correlation})
    *value /= std::max(1.0, n);
  result.dynamics = mean;
}

}  // namespace animeme::dam
