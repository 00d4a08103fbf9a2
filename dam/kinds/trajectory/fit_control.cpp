#include "dam/kinds/trajectory/fit_control.h"

#include <algorithm>
#include <cmath>

namespace animeme::dam {
namespace {

constexpr int kConjugateSteps = 20;
constexpr double kConjugateTolerance = 1e-2;  // of the gradient, in the norm of the scales
constexpr double kLargestStep = 1.0;          // of a logarithm at once
constexpr int kTries = 6;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The derivative of the frames by the parameters, as two maps.
class Jacobian {
 public:
  Jacobian(const TrajectoryData& data, const Gaussians& gaussians, const Trajectory& trajectory)
      : data_(data),
        trajectory_(trajectory),
        states_(gaussians.states()),
        pull_(data.grid.points()) {
    const std::span<const double> y = trajectory.values();
    for (std::size_t s = 0; s < states_; ++s)
      precision_.push_back(std::exp(gaussians.log_precision[s]));
    for (const Run& run : data.grid.runs) {
      const auto rough = roughness(y.subspan(run.begin, run.points), data.order);
      for (std::size_t i = 0; i < run.points; ++i)
        pull_[run.begin + i] = 2 * double(data.order) * trajectory.weight() * rough[i];
    }
    for (std::size_t i = 0; i < data.grid.points(); ++i)
      for (const Cover& cover : data.grid.at(i))
        distance_.push_back(gaussians.mean[cover.state] - y[i]);
  }

  std::vector<double> forward(const std::vector<double>& v) const {
    std::vector<double> x(data_.grid.points(), 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = data_.grid.begin[i]; j < data_.grid.begin[i + 1]; ++j) {
        const Cover& cover = data_.grid.covers[j];
        x[i] += cover.share * precision_[cover.state] *
                (v[cover.state] + distance_[j] * v[states_ + cover.state]);
      }
      x[i] -= pull_[i] * v[2 * states_];
    }
    trajectory_.solve(x);
    std::vector<double> frames;
    frames.reserve(data_.observed.size());
    for (const Observed& o : data_.observed) {
      double sum = 0;
      for (std::size_t m = 0; m < 4; ++m) sum += o.reading.weight[m] * x[o.reading.point + m];
      frames.push_back(sum);
    }
    return frames;
  }

  std::vector<double> transposed(const std::vector<double>& frames) const {
    std::vector<double> x(data_.grid.points(), 0.0);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const Reading& reading = data_.observed[f].reading;
      for (std::size_t m = 0; m < 4; ++m) x[reading.point + m] += reading.weight[m] * frames[f];
    }
    trajectory_.solve(x);
    std::vector<double> v(2 * states_ + 1, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = data_.grid.begin[i]; j < data_.grid.begin[i + 1]; ++j) {
        const Cover& cover = data_.grid.covers[j];
        const double part = cover.share * precision_[cover.state] * x[i];
        v[cover.state] += part;
        v[states_ + cover.state] += part * distance_[j];
      }
      v[2 * states_] -= pull_[i] * x[i];
    }
    return v;
  }

 private:
  const TrajectoryData& data_;
  const Trajectory& trajectory_;
  std::size_t states_;
  std::vector<double> precision_;
  std::vector<double> pull_;      ///< of the smoothness on a point
  std::vector<double> distance_;  ///< from the trajectory to the mean, per cover
};

/// (J^T J + diag) x = b by conjugate gradients, from 0.
std::vector<double> solve_step(const Jacobian& jacobian, const std::vector<double>& diagonal,
                               const std::vector<double>& scale, const std::vector<double>& b) {
  std::vector<double> x(b.size(), 0.0), residual = b, z(b.size()), direction;
  double last = 0;
  double first = 0;
  for (int k = 0; k < kConjugateSteps; ++k) {
    for (std::size_t i = 0; i < b.size(); ++i) z[i] = residual[i] / scale[i];
    const double length = dot(residual, z);
    if (k == 0) first = length;
    if (!(length > kConjugateTolerance * kConjugateTolerance * first)) break;
    if (k == 0) {
      direction = z;
    } else {
      for (std::size_t i = 0; i < b.size(); ++i) direction[i] = z[i] + length / last * direction[i];
    }
    last = length;
    std::vector<double> image = jacobian.transposed(jacobian.forward(direction));
    for (std::size_t i = 0; i < b.size(); ++i) image[i] += diagonal[i] * direction[i];
    const double curvature = dot(direction, image);
    if (!(curvature > 0)) break;
    for (std::size_t i = 0; i < b.size(); ++i) {
      x[i] += length / curvature * direction[i];
      residual[i] -= length / curvature * image[i];
    }
  }
  return x;
}

}  // namespace

ControlFit::ControlFit(const TrajectoryData& data, std::vector<double> target, Gaussians start,
                       const TrajectoryPrior& prior)
    : data_(data),
      target_(std::move(target)),
      start_(std::move(start)),
      now_(start_),
      prior_(prior) {
  objective_ = evaluate(now_, Trajectory(data_.grid, data_.order, now_));
}

ControlFit::Vector ControlFit::pack(const Gaussians& g) const {
  Vector v = g.mean;
  v.insert(v.end(), g.log_precision.begin(), g.log_precision.end());
  v.push_back(g.log_smoothness);
  return v;
}

ControlFit::Vector ControlFit::prior_weights() const {
  Vector w(now_.states(), prior_.mean);
  w.insert(w.end(), now_.states(), prior_.precision);
  w.push_back(prior_.smoothness);
  return w;
}

/// How much the frames have to say about each parameter, roughly: the preconditioner.
ControlFit::Vector ControlFit::scales() const {
  constexpr double kOfPrecision = 0.05, kOfSmoothness = 0.02;
  Vector w = prior_weights();
  for (std::size_t s = 0; s < now_.states(); ++s) {
    w[s] += 1e-6 + data_.frames[s];
    w[now_.states() + s] += 1e-6 + kOfPrecision * data_.frames[s];
  }
  w.back() += 1e-6 + kOfSmoothness * double(data_.observed.size());
  return w;
}

double ControlFit::evaluate(const Gaussians& gaussians, const Trajectory& trajectory) const {
  double sum = 0;
  for (std::size_t f = 0; f < target_.size(); ++f) {
    const double error = target_[f] - trajectory.read(data_.observed[f].reading);
    sum += error * error;
  }
  const Vector now = pack(gaussians), centre = pack(start_), weight = prior_weights();
  for (std::size_t i = 0; i < now.size(); ++i)
    sum += weight[i] * (now[i] - centre[i]) * (now[i] - centre[i]);
  return sum;
}

Gaussians ControlFit::moved(const Vector& delta) const {
  const std::size_t n = now_.states();
  const auto shift = [](double value, double by, double low, double high) {
    return std::clamp(value + std::clamp(by, -kLargestStep, kLargestStep), low, high);
  };
  Gaussians next = now_;
  for (std::size_t s = 0; s < n; ++s) {
    next.mean[s] += delta[s];
    next.log_precision[s] = shift(now_.log_precision[s], delta[n + s], -std::log(kLargestVariance),
                                  -std::log(kLeastVariance));
  }
  next.log_smoothness = shift(now_.log_smoothness, delta[2 * n], std::log(kLeastSmoothness),
                              std::log(kLargestSmoothness));
  return next;
}

bool ControlFit::step() {
  const Trajectory trajectory(data_.grid, data_.order, now_);
  const Jacobian jacobian(data_, now_, trajectory);
  Vector residual(target_.size());
  for (std::size_t f = 0; f < target_.size(); ++f)
    residual[f] = target_[f] - trajectory.read(data_.observed[f].reading);
  Vector downhill = jacobian.transposed(residual);
  const Vector now = pack(now_), centre = pack(start_), prior = prior_weights(), scale = scales();
  for (std::size_t i = 0; i < now.size(); ++i) downhill[i] -= prior[i] * (now[i] - centre[i]);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Vector diagonal = prior, damped = scale;
    for (std::size_t i = 0; i < now.size(); ++i) {
      diagonal[i] += damping_ * scale[i];
      damped[i] += damping_ * scale[i];
    }
    const Gaussians next = moved(solve_step(jacobian, diagonal, damped, downhill));
    const double objective = evaluate(next, Trajectory(data_.grid, data_.order, next));
    if (objective < objective_) {
      now_ = next;
      objective_ = objective;
      damping_ = std::max(1e-4, damping_ / 5);
      return true;
    }
    damping_ *= 5;
  }
  return false;
}

}  // namespace animeme::dam
