// Timing error of velocity peaks: dynamic time warping of every control's velocity, for each run of
// speech, and the distance of each recorded extreme from its position on the path.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"

namespace animeme::dam {
namespace {

constexpr double kBand = 0.200;          // seconds that the path may leave the diagonal
constexpr double kNotable = 1;           // extremes below this many rms velocities are noise
constexpr std::size_t kShortestRun = 5;  // frames; shorter ones have no extreme inside

/// Distances of the extremes, in seconds.
struct WarpSums {
  std::size_t extremes = 0;
  double distance = 0, offset = 0;
};

std::vector<double> velocities(const std::vector<double>& x, const FrameRun& run) {
  std::vector<double> v;
  for (std::size_t i = run.begin + 1; i + 1 < run.end; ++i) v.push_back(derivative(x, i, 1));
  return v;
}

bool is_extreme(const std::vector<double>& v, std::size_t i) {
  if (i == 0 || i + 1 >= v.size() || std::abs(v[i]) < kNotable) return false;
  const double sign = v[i] > 0 ? 1 : -1;
  return sign * v[i] > sign * v[i - 1] && sign * v[i] >= sign * v[i + 1];
}

/// The cheapest monotonous path between two series of the same length, within a band. Steps are
/// diagonal, along a, along b; the first of these wins a tie.
class Warp {
 public:
  Warp(const std::vector<double>& a, const std::vector<double>& b, std::size_t band)
      : n_(a.size()), band_(band), width_(2 * band + 1), step_(n_ * width_, 0) {
    std::vector<double> before(width_, kFar), now(width_, kFar);
    for (std::size_t i = 0; i < n_; ++i) {
      std::fill(now.begin(), now.end(), kFar);
      for (std::size_t k = 0; k < width_; ++k) {
        if (i + k < band_ || i + k - band_ >= n_) continue;
        const double cost = std::pow(a[i] - b[i + k - band_], 2);
        now[k] = cost + best_before(i, k, before, now);
      }
      std::swap(before, now);
    }
  }

  /// For every frame of a, the mean of the frames of b that the path matches with it.
  std::vector<double> partners() const {
    std::vector<double> sum(n_, 0), count(n_, 0);
    std::size_t i = n_ - 1, k = band_;
    while (true) {
      sum[i] += double(i + k - band_);
      count[i] += 1;
      if (i == 0 && k == band_) break;
      const std::uint8_t step = step_[i * width_ + k];
      if (step != 2) --i;  // in the band of the row before, the same frame of b is one further
      if (step == 1) ++k;
      if (step == 2) --k;
    }
    for (std::size_t j = 0; j < n_; ++j) sum[j] /= count[j];
    return sum;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  double best_before(std::size_t i, std::size_t k, const std::vector<double>& before,
                     const std::vector<double>& now) {
    if (i == 0 && k == band_) return 0;
    double best = i > 0 ? before[k] : kFar;
    std::uint8_t step = 0;
    if (i > 0 && k + 1 < width_ && before[k + 1] < best) {
      best = before[k + 1];
      step = 1;
    }
    if (k > 0 && now[k - 1] < best) {
      best = now[k - 1];
      step = 2;
    }
    step_[i * width_ + k] = step;
    return best;
  }

  std::size_t n_, band_, width_;
  std::vector<std::uint8_t> step_;
};

void add_run(std::vector<double> made, std::vector<double> recorded, double rms_made,
             double rms_recorded, fap::Rate rate, WarpSums& sums) {
  for (double& v : made) v /= rms_made;
  for (double& v : recorded) v /= rms_recorded;
  const auto band = std::size_t(std::ceil(kBand * rate.frames_per_second()));
  const auto partners = Warp(recorded, made, std::min(band, recorded.size() - 1)).partners();
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    if (!is_extreme(recorded, i)) continue;
    const double offset = rate.seconds(partners[i] - double(i));
    ++sums.extremes;
    sums.offset += offset;
    sums.distance += std::abs(offset);
  }
}

double rms_velocity(const AllSeries& all, std::size_t control, bool of_made) {
  double n = 0, sum = 0;
  for (const PairSeries& pair : all)
    for (const FrameRun& run : frame_runs(pair.speech))
      for (const double v :
           velocities((of_made ? pair.synthesised : pair.recorded)[control], run)) {
        n += 1;
        sum += v * v;
      }
  return n > 0 ? std::sqrt(sum / n) : 0;
}

}  // namespace

void score_misalignment(const Layout& layout, const AllSeries& all, Evaluation& result) {
  WarpSums sums;
  for (std::size_t c = 0; c < layout.controls.size(); ++c) {
    if (!layout.scored[c]) continue;
    const double made = rms_velocity(all, c, true), recorded = rms_velocity(all, c, false);
    if (!(made > 0) || !(recorded > 0)) continue;
    for (const PairSeries& pair : all)
      for (const FrameRun& run : frame_runs(pair.speech))
        if (run.end - run.begin >= kShortestRun)
          add_run(velocities(pair.synthesised[c], run), velocities(pair.recorded[c], run), made,
                  recorded, pair.signal().rate, sums);
  }
  const double n = std::max(1.0, double(sums.extremes));
  result.timing.extremes = sums.extremes;
  result.timing.misalignment = sums.distance / n * 1000;
  result.timing.offset = sums.offset / n * 1000;
}

}  // namespace animeme::dam
