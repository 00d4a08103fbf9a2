// Ratios of synthesised to recorded dynamics; over-smoothing gives ratios below 1.
#include <algorithm>
#include <optional>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"
#include "dam/signal/fap_signal.h"

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
    const auto& a = pair.synthesised[series];
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

/// Controls that move together, as people look at a mouth.
struct MouthPart {
  const char* name;
  std::initializer_list<int> faps;
};
constexpr MouthPart kMouthParts[] = {{"jaw", {3}},
                                     {"upper lip", {4, 8, 9, 51, 55, 56}},
                                     {"lower lip", {5, 10, 11, 52, 57, 58}},
                                     {"corners", {6, 7, 12, 13, 53, 54, 59, 60}}};

/// Means over the scored series that `wanted` says true of; nothing: there is none.
template <class Wanted>
std::optional<DynamicsScore> mean_of(const char* name, const std::vector<DynamicsScore>& all,
                                     const Wanted& wanted) {
  double n = 0;
  DynamicsScore mean{name, true, 0, 0, 0, 0, 0};
  for (const DynamicsScore& one : all) {
    if (!one.scored || !wanted(one)) continue;
    n += 1;
    mean.velocity += one.velocity;
    mean.acceleration += one.acceleration;
    mean.jerk += one.jerk;
    mean.range += one.range;
    mean.velocity_correlation += one.velocity_correlation;
  }
  if (n == 0) return std::nullopt;
  for (double* value :
       {&mean.velocity, &mean.acceleration, &mean.jerk, &mean.range, &mean.velocity_correlation})
    *value /= n;
  return mean;
}

}  // namespace

void score_dynamics(const Layout& layout, const AllSeries& all, Evaluation& result) {
  for (std::size_t s = 0; s < layout.series(); ++s)
    result.series_dynamics.push_back(score_series(layout, all, s));
  const auto any = [](const DynamicsScore&) { return true; };
  result.dynamics = mean_of("mean", result.series_dynamics, any)
                        .value_or(DynamicsScore{"mean", true, 0, 0, 0, 0, 0});
  for (const MouthPart& group : kMouthParts) {
    const auto in_group = [&](const DynamicsScore& one) {
      return std::find(group.faps.begin(), group.faps.end(), fap_of_channel(one.name)) !=
             group.faps.end();
    };
    if (const auto mean = mean_of(group.name, result.series_dynamics, in_group))
      result.group_dynamics.push_back(*mean);
  }
}

}  // namespace animeme::dam
