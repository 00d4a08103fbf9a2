// Training of one control: the Gaussians and the smoothness whose trajectory is nearest to the
// recording. Source: Ezzat, Geiger, Poggio, "Trainable videorealistic speech animation", section 8;
// there by gradient descent, here by Gauss-Newton steps, solved by conjugate gradients.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dam/kinds/trajectory/band.h"
#include "dam/kinds/trajectory/grid.h"

namespace animeme::dam {

/// What is known of one control. Logarithms keep precisions and times above 0.
struct Gaussians {
  std::vector<double> mean;           ///< per state
  std::vector<double> log_precision;  ///< -log(variance), per state
  double log_smoothness = 0;          ///< log of seconds

  std::size_t states() const { return mean.size(); }
};

/// Bounds that TrajectoryParameters has.
inline constexpr double kLeastVariance = 1e-4, kLargestVariance = 1e4;
inline constexpr double kLeastSmoothness = 0.001, kLargestSmoothness = 0.5;

/// A frame of the recording and where the grid has it.
struct Observed {
  Reading reading;
  std::size_t frame = 0;
};

/// What all controls share.
struct TrajectoryData {
  Grid grid;
  std::vector<Observed> observed;
  std::vector<double> frames;  ///< observed frames per state
  std::size_t order = 2;
};

/// Trust in the start values, in frames.
struct TrajectoryPrior {
  double mean = 1;
  double precision = 1;
  double smoothness = 1;
};

/// The trajectory of a control on the grid, and what it takes to move it.
class Trajectory {
 public:
  Trajectory(const Grid& grid, std::size_t order, const Gaussians& gaussians);

  std::span<const double> values() const { return values_; }
  double read(const Reading& reading) const;
  /// Solves for another right side, run by run.
  void solve(std::span<double> x) const;
  double weight() const { return weight_; }

 private:
  const Grid& grid_;
  double weight_;
  std::vector<BandFactor> factors_;
  std::vector<double> values_;
};

class ControlFit {
 public:
  /// `target` holds the recorded value of each of data.observed. `start` is also the centre of the
  /// prior.
  ControlFit(const TrajectoryData& data, std::vector<double> target, Gaussians start,
             const TrajectoryPrior& prior);

  /// Squared error and prior; falls with every step.
  double objective() const { return objective_; }
  const Gaussians& gaussians() const { return now_; }
  /// One accepted Gauss-Newton step; false if none could be found.
  bool step();

 private:
  using Vector = std::vector<double>;  ///< means, log precisions, log smoothness

  double evaluate(const Gaussians& gaussians, const Trajectory& trajectory) const;
  Vector pack(const Gaussians& gaussians) const;
  Gaussians moved(const Vector& delta) const;
  Vector prior_weights() const;
  Vector scales() const;

  const TrajectoryData& data_;
  std::vector<double> target_;
  Gaussians start_, now_;
  TrajectoryPrior prior_;
  double objective_ = 0;
  double damping_ = 1e-2;
};

}  // namespace animeme::dam
