// RMSE and similar errors, over speech and silence.
#include <cmath>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"

namespace animeme::dam {
namespace {

/// What one region is scored from.
struct RegionSums {
  std::size_t frames = 0;
  std::vector<Comparison> series;
  std::vector<double> still;  // squared errors of the mean pose
  double l2 = 0;
};

void add_still(const Layout& layout, const PairSeries& pair, std::size_t frame, RegionSums& sums) {
  for (std::size_t c = 0; c < layout.controls.size(); ++c)
    sums.still[c] += std::pow(pair.recorded[c][frame] - layout.controls[c].mean, 2);
}

RegionSums sum_region(const Layout& layout, const AllSeries& all,
                      std::vector<bool> PairSeries::*mask) {
  RegionSums sums;
  sums.series.resize(layout.series());
  sums.still.resize(layout.controls.size());
  for (const PairSeries& pair : all) {
    ErrorSums own;
    for (std::size_t i = 0; i < pair.frames(); ++i) {
      if (!(pair.*mask)[i]) continue;
      for (std::size_t s = 0; s < layout.series(); ++s)
        sums.series[s].add(pair.synthesised[s][i], pair.recorded[s][i]);
      add_still(layout, pair, i, sums);
      add_frame(layout, pair, i, own);
    }
    sums.frames += own.frames;
    sums.l2 += own.l2;
  }
  return sums;
}

SeriesScore series_score(const std::string& name, bool scored, const Comparison& c, double sd) {
  return {name,
          scored,
          c.rmse(),
          sd > 0 ? c.rmse() / sd : 0.0,
          c.largest,
          c.correlation(),
          c.gain(),
          c.offset(),
          c.fitted_nrmse()};
}

void finish_region(const Layout& layout, const RegionSums& sums, RegionScore& region) {
  region.frames = sums.frames;
  const double frames = std::max(1.0, double(sums.frames));
  const double scored = std::max(1.0, double(layout.scored_count()));
  for (std::size_t c = 0; c < layout.controls.size(); ++c) {
    const double sd = layout.controls[c].sd;
    region.controls.push_back(
        series_score(layout.controls[c].name, layout.scored[c], sums.series[c], sd));
    if (!layout.scored[c]) continue;
    region.nrmse += region.controls.back().nrmse;
    region.fitted_nrmse += region.controls.back().fitted_nrmse;
    region.still_nrmse += std::sqrt(sums.still[c] / frames) / sd;
    region.correlation += region.controls.back().correlation;
  }
  region.nrmse /= scored;
  region.still_nrmse /= scored;
  region.fitted_nrmse /= scored;
  region.correlation /= scored;
  region.l2 = sums.l2 / frames;
  for (std::size_t m = 0; m < layout.measures.size(); ++m) {
    const Comparison& comparison = sums.series[layout.controls.size() + m];
    region.measures.push_back(
        series_score(layout.measures[m].name, false, comparison, comparison.deviation_b()));
  }
}

}  // namespace

void add_frame(const Layout& layout, const PairSeries& pair, std::size_t frame, ErrorSums& sums) {
  sums.squared.resize(layout.scored_count());
  double norm = 0;
  for (std::size_t c = 0, k = 0; c < layout.controls.size(); ++c) {
    if (!layout.scored[c]) continue;
    const double error =
        std::pow((pair.synthesised[c][frame] - pair.recorded[c][frame]) / layout.controls[c].sd, 2);
    sums.squared[k++] += error;
    norm += error;
  }
  ++sums.frames;
  sums.l2 += std::sqrt(norm);
  if (layout.gap < 0) return;
  const auto gap = std::size_t(layout.gap);
  sums.gap_squared += std::pow(pair.synthesised[gap][frame] - pair.recorded[gap][frame], 2);
}

void ErrorSums::add(const ErrorSums& other) {
  if (squared.size() < other.squared.size()) squared.resize(other.squared.size());
  for (std::size_t c = 0; c < other.squared.size(); ++c) squared[c] += other.squared[c];
  frames += other.frames;
  l2 += other.l2;
  gap_squared += other.gap_squared;
}

double ErrorSums::nrmse() const {
  if (frames == 0 || squared.empty()) return 0;
  double sum = 0;
  for (const double s : squared) sum += std::sqrt(s / double(frames));
  return sum / double(squared.size());
}

double ErrorSums::mean_l2() const { return frames > 0 ? l2 / double(frames) : 0; }

double ErrorSums::gap_rmse() const {
  return frames > 0 ? std::sqrt(gap_squared / double(frames)) : 0;
}

void score_regions(const Layout& layout, const AllSeries& all, Evaluation& result) {
  finish_region(layout, sum_region(layout, all, &PairSeries::speech), result);
  finish_region(layout, sum_region(layout, all, &PairSeries::silence), result.silence);
  for (const PairSeries& pair : all) {
    ErrorSums sums;
    Comparison gap;
    for (std::size_t i = 0; i < pair.frames(); ++i) {
      if (!pair.speech[i]) continue;
      add_frame(layout, pair, i, sums);
      if (layout.gap >= 0)
        gap.add(pair.synthesised[std::size_t(layout.gap)][i],
                pair.recorded[std::size_t(layout.gap)][i]);
    }
    result.seconds += pair.seconds(double(sums.frames));
    result.gap_correlation += gap.correlation() / double(all.size());
    result.per_utterance.push_back({pair.pair->recorded.id, sums.frames, sums.nrmse(),
                                    sums.mean_l2(), sums.gap_rmse(), gap.correlation(), sums});
  }
}

}  // namespace animeme::dam
