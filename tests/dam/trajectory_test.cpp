// The trajectory model against signals and matrices that are known.
#include <gtest/gtest.h>

#include <cmath>

#include "dam/kinds/trajectory/fit_control.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace trajectory_test {

using test::Uniform;
constexpr Window kEverything{-1e9, 1e9};

/// diag(precision) + weight * D^T D, row by row, from repeated differences of unit vectors.
std::vector<double> dense(const std::vector<double>& precision, double weight, std::size_t order) {
  const std::size_t n = precision.size();
  std::vector<std::vector<double>> difference(n);  // [column]
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> column(n, 0.0);
    column[i] = 1;
    for (std::size_t k = 0; k < order && !column.empty(); ++k) {
      for (std::size_t m = 0; m + 1 < column.size(); ++m) column[m] = column[m + 1] - column[m];
      column.pop_back();
    }
    difference[i] = column;
  }
  std::vector<double> matrix(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t m = 0; m < difference[i].size(); ++m)
        matrix[i * n + j] += weight * difference[i][m] * difference[j][m];
      if (i == j) matrix[i * n + j] += precision[i];
    }
  return matrix;
}

TEST(Band, SolvesWhatTheDenseMatrixSays) {
  Uniform random(1);
  for (std::size_t order = 1; order <= kMaxDifference; ++order)
    for (const std::size_t n : {1u, 2u, 3u, 5u, 6u, 40u}) {
      std::vector<double> precision(n), right(n);
      for (double& v : precision) v = random(0.1, 3);
      for (double& v : right) v = random(-1, 1);
      BandFactor factor;
      factor.factor(precision, 7.5, order);
      std::vector<double> x = right;
      factor.solve(x);
      const auto matrix = dense(precision, 7.5, order);
      const auto rough = roughness(x, order);
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += matrix[i * n + j] * x[j];
        EXPECT_NEAR(sum, right[i], 1e-9) << "order " << order << ", " << n << " points";
        EXPECT_NEAR(precision[i] * x[i] + 7.5 * rough[i], right[i], 1e-9);
      }
    }
}

TEST(Grid, EveryMomentOfTheSpeechIsCoveredOnce) {
  const std::vector<Piece> pieces = {{0.013, 0.1, 2}, {0.113, 0.005, 0}, {0.118, 0.333, 1}};
  Grid grid;
  add_run(pieces, 3, kEverything, grid);
  std::vector<double> seconds(9, 0.0);
  for (std::size_t i = 0; i < grid.points(); ++i) {
    double sum = 0;
    for (const Cover& cover : grid.at(i)) {
      seconds[cover.state] += cover.share * kGridStep;
      sum += cover.share;
    }
    EXPECT_LE(sum, 1 + 1e-9);
  }
  for (const Piece& piece : pieces)
    for (std::size_t s = 0; s < 3; ++s)
      EXPECT_NEAR(seconds[std::size_t(piece.phone) * 3 + s], piece.duration / 3, 1e-9);
}

TEST(Grid, ReadsCubicCurvesExactly) {
  const std::vector<Piece> pieces = {{0.5, 0.3, 0}};
  Grid grid;
  add_run(pieces, 1, kEverything, grid);
  const auto& run = grid.runs[0];
  const auto cubic = [](double t) { return 1 + t * (2 - t * (3 - 4 * t)); };
  for (const double time : {0.5, 0.5001, 0.617, 0.78, 0.8}) {
    const Reading reading = read_at(run, time);
    double sum = 0;
    for (std::size_t m = 0; m < 4; ++m) {
      ASSERT_LT(reading.point + m, run.begin + run.points);
      const auto at = double(run.first + std::int64_t(reading.point + m - run.begin));
      sum += reading.weight[m] * cubic(at * kGridStep);
    }
    EXPECT_NEAR(sum, cubic(time), 1e-12);
  }
}

TEST(Grid, PausesPartTheRuns) {
  const std::vector<Piece> pieces = {{0, 0.1, 0}, {0.1, 0.1, 1}, {0.5, 0.1, 0}};
  EXPECT_EQ(run_ends(pieces), (std::vector<std::size_t>{2, 3}));
  Grid grid;
  add_run(pieces, 1, {5, 6}, grid);  // all before the window
  EXPECT_TRUE(grid.runs.empty());
}

/// Sentences of four phones at random, read at 40 frames per second.
TrajectoryData random_data(Uniform& random, std::size_t states) {
  TrajectoryData data;
  data.frames.assign(4 * states, 100.0);
  for (int sentence = 0; sentence < 12; ++sentence) {
    std::vector<Piece> pieces;
    double t = 0.1;
    for (int j = 0; j < 25; ++j) {
      const double duration = random(0.06, 0.25);
      pieces.push_back({t, duration, std::int32_t(random.below(4))});
      t += duration;
    }
    add_run(pieces, states, kEverything, data.grid);
    for (int frame = 5; frame / 40.0 < t - 0.05; ++frame)
      data.observed.push_back({read_at(data.grid.runs.back(), frame / 40.0), 0});
  }
  return data;
}

Gaussians random_gaussians(Uniform& random, std::size_t states) {
  Gaussians g;
  for (std::size_t s = 0; s < states; ++s) {
    g.mean.push_back(random(-2, 2));
    g.log_precision.push_back(random(-1, 1));
  }
  g.log_smoothness = std::log(0.03);
  return g;
}

TEST(Trajectory, IsTheMeanWhereOneStateLasts) {
  const std::vector<Piece> pieces = {{0, 3, 0}};
  Grid grid;
  add_run(pieces, 1, kEverything, grid);
  const Trajectory trajectory(grid, 2, {{1.5}, {0}, std::log(0.03)});
  EXPECT_NEAR(trajectory.read(read_at(grid.runs[0], 1.5)), 1.5, 1e-4);
}

TEST(Trajectory, TrainingFindsThePlantedMeans) {
  Uniform random(2);
  for (const std::size_t states : {1u, 3u}) {
    const TrajectoryData data = random_data(random, states);
    const Gaussians truth = random_gaussians(random, 4 * states);
    const Trajectory planted(data.grid, data.order, truth);
    std::vector<double> target;
    for (const Observed& o : data.observed) target.push_back(planted.read(o.reading));
    Gaussians start{std::vector<double>(4 * states, 0.0), std::vector<double>(4 * states, 0.0),
                    std::log(0.05)};
    ControlFit fit(data, target, start, {1e-6, 1e-6, 1e-6});
    const double before = fit.objective();
    double last = before;
    for (int k = 0; k < 100 && fit.step(); ++k) {
      EXPECT_LT(fit.objective(), last);
      last = fit.objective();
    }
    EXPECT_LT(last, 1e-4 * before) << states << " states";
    for (std::size_t s = 0; s < 4 * states; ++s)
      EXPECT_NEAR(fit.gaussians().mean[s], truth.mean[s], 0.1) << states << " states";
  }
}

}  // namespace trajectory_test
}  // namespace animeme::dam
