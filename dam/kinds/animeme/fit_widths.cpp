// The M-step: Gauss-Newton for the widths of the dominance (Eq. 8 and 9).
#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/fit.h"
#include "dam/kinds/animeme/fit_normal.h"
#include "dam/maths/parallel.h"
#include "dam/maths/projection.h"

namespace animeme::dam {
namespace {

/// Controls are worked on in blocks of this many: wide enough for vector units, small enough to
/// keep the projection's memory down.
constexpr std::size_t kBlock = 8;
constexpr double kMinLogSigma = -3, kMaxLogSigma = 1.6;

using Block = Eigen::Array<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, int(kBlock)>;

struct BlockSums {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  RowMatrix cross;  // (unknowns x modes) by controls of the block: X^T J
};

class BlockWorker {
 public:
  BlockWorker(const FitData& data, const FitState& state, std::size_t first, std::size_t width,
              bool project)
      : data_(data), state_(state), first_(first), width_(width), project_(project) {
    const auto modes = Eigen::Index(state.sigma.size());
    sums_.gradient = Eigen::VectorXd::Zero(modes);
    sums_.hessian = Eigen::MatrixXd::Zero(modes, modes);
    if (project)
      sums_.cross =
          RowMatrix::Zero(modes * Eigen::Index(data.terms()) * modes, Eigen::Index(width));
  }

  BlockSums run() {
    for (const FitSentence& sentence : data_.sentences) {
      const Design design = make_design(data_, sentence, state_.sigma);
      for (std::size_t i = 0; i < sentence.frames; ++i)
        if (data_.use[sentence.first_frame + i] != 0)
          add_frame(design.frame(i), sentence.first_frame + i);
    }
    return std::move(sums_);
  }

 private:
  void add_frame(std::span<const Part> parts, std::size_t frame) {
    const std::size_t k = data_.controls;
    const auto n = Eigen::Index(width_);
    Block residual = Eigen::Map<const Block>(&data_.target[frame * k + first_], n);
    slopes_.resize(parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Block value = Block::Zero(n);
      for (std::size_t m = 0; m < data_.terms(); ++m)
        value += parts[p].basis[m] *
                 Eigen::Map<const Block>(
                     &state_.coefficients[(parts[p].mode * data_.terms() + m) * k + first_], n);
      residual -= parts[p].dominance * value;
      slopes_[p] = value;
    }
    // dC/d log(sigma_j) = D_j' A_j, or D_j' (A_j - C) / sum D if normalised.
    Block blend = Block::Zero(n);
    if (data_.normalised) {
      blend = Eigen::Map<const Block>(&data_.target[frame * k + first_], n) - residual;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      slopes_[p] = parts[p].slope * (slopes_[p] - blend);
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].slope == 0) continue;
      const auto g = Eigen::Index(parts[p].mode);
      sums_.gradient[g] += (slopes_[p] * residual).sum();
      for (std::size_t q = 0; q < parts.size(); ++q)
        if (parts[q].slope != 0)
          sums_.hessian(g, Eigen::Index(parts[q].mode)) += (slopes_[p] * slopes_[q]).sum();
      if (project_) add_cross(parts, p);
    }
  }

  void add_cross(std::span<const Part> parts, std::size_t p) {
    const std::size_t modes = state_.sigma.size();
    for (const Part& x : parts)
      for (std::size_t m = 0; m < data_.terms(); ++m) {
        const double w = x.dominance * x.basis[m];
        const std::size_t unknown = x.mode * data_.terms() + m;
        sums_.cross.row(Eigen::Index(unknown * modes + parts[p].mode)).array() += w * slopes_[p];
      }
  }

  const FitData& data_;
  const FitState& state_;
  std::size_t first_, width_;
  bool project_;
  BlockSums sums_;
  std::vector<Block> slopes_;
};

FitState moved(const FitState& from, const Eigen::VectorXd& delta) {
  FitState to;
  to.sigma = from.sigma;
  for (std::size_t g = 0; g < to.sigma.size(); ++g)
    to.sigma[g] = std::exp(
        std::clamp(std::log(to.sigma[g]) + delta[Eigen::Index(g)], kMinLogSigma, kMaxLogSigma));
  return to;
}

}  // namespace

WidthStep width_step(const FitData& data, const FitWeights& weights, const FitState& state,
                     bool project) {
  const std::size_t modes = state.sigma.size();
  std::vector<BlockSums> blocks((data.controls + kBlock - 1) / kBlock);
  Normal normal;
  if (project) normal = make_normal(data, weights, state.sigma);
  parallel_for(blocks.size(), weights.threads, [&](std::size_t b) {
    const std::size_t first = b * kBlock;
    BlockWorker worker(data, state, first, std::min(kBlock, data.controls - first), project);
    blocks[b] = worker.run();
    if (project) project_out(normal.factor, blocks[b].cross, blocks[b].hessian);
    blocks[b].cross.resize(0, 0);
  });
  const double prior = weights.width_prior * double(data.controls);
  WidthStep step;
  step.gradient.resize(modes);
  step.hessian.assign(modes * modes, 0.0);
  for (std::size_t g = 0; g < modes; ++g) {
    step.gradient[g] = -prior * std::log(state.sigma[g]);
    step.hessian[g * modes + g] = prior;
  }
  for (const BlockSums& block : blocks) {
    Eigen::Map<Eigen::VectorXd>(step.gradient.data(), Eigen::Index(modes)) += block.gradient;
    Eigen::Map<Eigen::MatrixXd>(step.hessian.data(), Eigen::Index(modes), Eigen::Index(modes)) +=
        block.hessian;
  }
  return step;
}

bool expectation_maximisation(const FitData& data, const FitWeights& weights, int max_iterations,
                              double tolerance, FitState& state,
                              const std::function<bool(const FitState&)>& accepted) {
  double damping = 1e-2;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const WidthStep step = width_step(data, weights, state, true);
    bool fell = false;
    double gain = 0;
    for (int attempt = 0; attempt < 8 && !fell; ++attempt) {
      FitState trial = moved(state, damped_step(step.gradient, step.hessian, damping));
      solve_coefficients(data, weights, trial);
      fell = trial.objective < state.objective;
      damping = fell ? std::max(1e-6, damping / 5) : damping * 5;
      if (!fell) continue;
      gain = (state.objective - trial.objective) / std::max(1e-300, state.objective);
      state = std::move(trial);
    }
    if (!fell) return true;
    if (!accepted(state)) return false;
    if (gain < tolerance) return true;
  }
  return false;
}

}  // namespace animeme::dam
