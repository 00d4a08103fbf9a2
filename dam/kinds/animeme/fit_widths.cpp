// The M-step: Gauss-Newton for the widths of the dominance (Eq. 8 and 9).
#include <algorithm>
#include <array>
#include <cmath>

#include "dam/kinds/animeme/fit.h"
#include "dam/kinds/animeme/fit_normal.h"
#include "dam/maths/linear_algebra.h"
#include "dam/maths/parallel.h"
#include "dam/maths/projection.h"

namespace animeme::dam {
namespace {

/// Controls are worked on in blocks of this many: wide enough for vector units, small enough to
/// keep the projection's memory down.
constexpr std::size_t kBlock = 8;
constexpr double kMinLogSigma = -3, kMaxLogSigma = 1.6;

using Block = std::array<double, kBlock>;  // zeros behind the controls of the block

struct BlockSums {
  std::vector<double> gradient;
  std::vector<double> hessian;
  std::vector<double> cross;  // (unknowns x modes) by controls of the block: X^T J
};

class BlockWorker {
 public:
  BlockWorker(const FitData& data, const FitState& state, std::size_t first, std::size_t width,
              bool project)
      : data_(data), state_(state), first_(first), width_(width), project_(project) {
    const std::size_t modes = state.sigma.size();
    sums_.gradient.assign(modes, 0.0);
    sums_.hessian.assign(modes * modes, 0.0);
    if (project) sums_.cross.assign(modes * data.terms() * modes * width, 0.0);
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
    const std::size_t k = data_.controls, modes = state_.sigma.size();
    const Block target = load(&data_.target[frame * k + first_]);
    Block residual = target;
    slopes_.resize(parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Block value{};
      for (std::size_t m = 0; m < data_.terms(); ++m) {
        const Block a =
            load(&state_.coefficients[(parts[p].mode * data_.terms() + m) * k + first_]);
        const double basis = parts[p].basis[m];
        for (std::size_t c = 0; c < kBlock; ++c) value[c] += basis * a[c];
      }
      const double dominance = parts[p].dominance;
      for (std::size_t c = 0; c < kBlock; ++c) residual[c] -= dominance * value[c];
      slopes_[p] = value;
    }
    // dC/d log(sigma_j) = D_j' A_j, or D_j' (A_j - C) / sum D if normalised.
    Block blend{};
    if (data_.normalised) {
      for (std::size_t c = 0; c < kBlock; ++c) blend[c] = target[c] - residual[c];
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const double slope = parts[p].slope;
      Block& block = slopes_[p];
      for (std::size_t c = 0; c < kBlock; ++c) block[c] = slope * (block[c] - blend[c]);
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].slope == 0) continue;
      const std::size_t g = parts[p].mode;
      sums_.gradient[g] += product(slopes_[p], residual);
      for (std::size_t q = 0; q < parts.size(); ++q)
        if (parts[q].slope != 0)
          sums_.hessian[parts[q].mode * modes + g] += product(slopes_[p], slopes_[q]);
      if (project_) add_cross(parts, p);
    }
  }

  /// The controls of the block of a row. A full block has a size that the compiler knows.
  Block load(const double* row) const {
    Block block{};
    if (width_ == kBlock) {
      for (std::size_t c = 0; c < kBlock; ++c) block[c] = row[c];
    } else {
      for (std::size_t c = 0; c < width_; ++c) block[c] = row[c];
    }
    return block;
  }

  double product(const Block& a, const Block& b) const {
    return width_ == kBlock ? dot(a.data(), b.data(), kBlock) : dot(a.data(), b.data(), width_);
  }

  void add_cross(std::span<const Part> parts, std::size_t p) {
    const std::size_t modes = state_.sigma.size();
    for (const Part& x : parts)
      for (std::size_t m = 0; m < data_.terms(); ++m) {
        const double w = x.dominance * x.basis[m];
        const std::size_t unknown = x.mode * data_.terms() + m;
        double* out = &sums_.cross[(unknown * modes + parts[p].mode) * width_];
        if (width_ == kBlock) {
          for (std::size_t c = 0; c < kBlock; ++c) out[c] += w * slopes_[p][c];
        } else {
          for (std::size_t c = 0; c < width_; ++c) out[c] += w * slopes_[p][c];
        }
      }
  }

  const FitData& data_;
  const FitState& state_;
  std::size_t first_, width_;
  bool project_;
  BlockSums sums_;
  std::vector<Block> slopes_;
};

FitState moved(const FitState& from, std::span<const double> delta) {
  FitState to;
  to.sigma = from.sigma;
  for (std::size_t g = 0; g < to.sigma.size(); ++g)
    to.sigma[g] =
        std::exp(std::clamp(std::log(to.sigma[g]) + delta[g], kMinLogSigma, kMaxLogSigma));
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
    const std::size_t width = std::min(kBlock, data.controls - first);
    blocks[b] = BlockWorker(data, state, first, width, project).run();
    if (project)
      project_out(normal.factor, modes * data.terms(), blocks[b].cross, width, blocks[b].hessian,
                  modes);
    blocks[b].cross = {};
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
    for (std::size_t g = 0; g < modes; ++g) step.gradient[g] += block.gradient[g];
    for (std::size_t i = 0; i < modes * modes; ++i) step.hessian[i] += block.hessian[i];
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
