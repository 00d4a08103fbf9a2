// Gauss-Newton for the dominance, the base curves being re-fitted to first order at every step
// (variable projection, Kaufman's form).
#include <algorithm>
#include <cmath>

#include "dam/kinds/refined/base_curves.h"
#include "dam/kinds/refined/dominance.h"
#include "dam/maths/linear_algebra.h"
#include "dam/maths/projection.h"

namespace animeme::dam {
namespace {

constexpr double kStartWidth = 0.08;
constexpr double kLeastWidth = 0.004, kMostWidth = 0.6, kMostLogStrength = 3;
constexpr std::size_t kPerPhone = 3;  // log L, log R, log strength

double prior_of(const RefinedData& data, const DominanceOptions& options,
                std::span<const PhoneDominance> dominance) {
  double sum = 0;
  for (const PhoneDominance& d : dominance)
    sum += std::pow(std::log(d.left / kStartWidth), 2) +
           std::pow(std::log(d.right / kStartWidth), 2) + std::pow(std::log(d.strength), 2);
  return options.prior * double(data.prior_controls) * sum;
}

/// Sums of the Gauss-Newton step.
struct StepSums {
  std::vector<double> gradient;
  std::vector<double> hessian;
  std::vector<double> cross;  // (unknowns x parameters) by controls: X^T J

  StepSums& operator+=(const StepSums& o) {
    add_all(gradient, o.gradient);
    add_all(hessian, o.hessian);
    add_all(cross, o.cross);
    return *this;
  }
};

class StepWorker {
 public:
  StepWorker(const RefinedData& data, const DominanceFit& fit, bool project)
      : data_(data), fit_(fit), project_(project), k_(data.controls) {}

  void add(const SentenceView& view, StepSums& sums) {
    const std::size_t parameters = sums.gradient.size(), unknowns = unknowns_of(data_);
    std::vector<double> slope_sum(parameters * k_), residual_sum(k_), column_sum(unknowns);
    for (const std::size_t i : view.used()) {
      const std::span<const RefinedPart> parts = view.parts(i);
      linearise(view, i);
      for (std::size_t c = 0; c < k_; ++c) residual_sum[c] += residual_[c];
      for (std::size_t p = 0; p < parts.size(); ++p) {
        add_slope_products(parts, p, slope_sum, sums);
        for (std::size_t m = 0; m < kRefinedOrders; ++m)
          column_sum[parts[p].phone * kRefinedOrders + m] += parts[p].weight * parts[p].basis[m];
      }
    }
    const double share = 1 / view.offset();
    subtract_product(slope_sum, residual_sum, share, sums.gradient);
    subtract_gram(slope_sum, k_, parameters, share, sums.hessian);
    if (!project_) return;
    for (std::size_t u = 0; u < unknowns; ++u) {
      if (column_sum[u] == 0) continue;
      const double scale = share * column_sum[u];
      double* out = &sums.cross[u * parameters * k_];
      for (std::size_t i = 0; i < parameters * k_; ++i) out[i] -= scale * slope_sum[i];
    }
  }

 private:
  /// residual_ becomes that of a frame, slopes_ w (A - C) of its parts.
  void linearise(const SentenceView& view, std::size_t i) {
    const std::span<const RefinedPart> parts = view.parts(i);
    slopes_.assign(parts.size() * k_, 0.0);
    blend_.assign(k_, 0.0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      double* value = &slopes_[p * k_];
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double* a = &fit_.base[(parts[p].phone * kRefinedOrders + m) * k_];
        add_row(value, parts[p].basis[m], a);
      }
      add_row(blend_.data(), parts[p].weight, value);
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const double weight = parts[p].weight;
      double* __restrict slope = &slopes_[p * k_];
      const double* __restrict blend = blend_.data();
      for (std::size_t c = 0; c < k_; ++c) slope[c] = weight * (slope[c] - blend[c]);
    }
    residual_.resize(k_);
    for (std::size_t c = 0; c < k_; ++c) residual_[c] = view.target(i)[c] - blend_[c];
  }

  void add_slope_products(std::span<const RefinedPart> parts, std::size_t p,
                          std::vector<double>& slope_sum, StepSums& sums) const {
    double fp[kPerPhone], fq[kPerPhone];
    factors(parts[p], fp);
    const std::size_t parameters = sums.gradient.size();
    const auto at = [&](std::size_t part) { return parts[part].phone * kPerPhone; };
    const double* slope = &slopes_[p * k_];
    const double along = dot(slope, residual_.data(), k_);
    for (std::size_t a = 0; a < kPerPhone; ++a) {
      sums.gradient[at(p) + a] += fp[a] * along;
      if (fp[a] != 0) add_row(&slope_sum[(at(p) + a) * k_], fp[a], slope);
    }
    for (std::size_t q = 0; q < parts.size(); ++q) {
      const double both = dot(slope, &slopes_[q * k_], k_);
      factors(parts[q], fq);
      for (std::size_t a = 0; a < kPerPhone; ++a)
        for (std::size_t b = 0; b < kPerPhone; ++b)
          sums.hessian[(at(q) + b) * parameters + at(p) + a] += fp[a] * fq[b] * both;
    }
    if (!project_) return;
    for (const RefinedPart& x : parts)
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double w = x.weight * x.basis[m];
        const std::size_t unknown = x.phone * kRefinedOrders + m;
        for (std::size_t a = 0; a < kPerPhone; ++a)
          if (fp[a] != 0)
            add_row(&sums.cross[(unknown * parameters + at(p) + a) * k_], w * fp[a], slope);
      }
  }

  void add_row(double* __restrict out, double scale, const double* __restrict row) const {
    for (std::size_t c = 0; c < k_; ++c) out[c] += scale * row[c];
  }

  /// d log D / d parameter.
  static void factors(const RefinedPart& part, double* f) {
    f[0] = 2 * part.before;
    f[1] = 2 * part.after;
    f[2] = 1;
  }

  const RefinedData& data_;
  const DominanceFit& fit_;
  bool project_;
  std::size_t k_;
  std::vector<double> slopes_, blend_, residual_;  // slopes_: parts x controls
};

std::vector<PhoneDominance> moved(std::span<const PhoneDominance> from, const DominanceStep& step,
                                  double damping) {
  const std::vector<double> delta = damped_step(step.gradient, step.hessian, damping);
  std::vector<PhoneDominance> to(from.begin(), from.end());
  for (std::size_t p = 0; p < to.size(); ++p) {
    const auto by = [&](std::size_t a) { return delta[p * kPerPhone + a]; };
    const auto width = [&](double w, double d) {
      return std::clamp(w * std::exp(d), kLeastWidth, kMostWidth);
    };
    to[p].left = width(to[p].left, by(0));
    to[p].right = width(to[p].right, by(1));
    to[p].strength =
        std::exp(std::clamp(std::log(to[p].strength) + by(2), -kMostLogStrength, kMostLogStrength));
  }
  return to;
}

}  // namespace

DominanceFit start_dominance(const RefinedData& data, const DominanceOptions& options,
                             std::span<const PhoneDominance> dominance) {
  DominanceFit fit;
  fit.dominance.assign(dominance.begin(), dominance.end());
  if (dominance.empty()) fit.dominance.assign(data.phones.size(), {kStartWidth, kStartWidth, 1});
  const Base base = solve_base(data, options, fit.dominance);
  fit.base = base.curves;
  fit.objective = base.objective + prior_of(data, options, fit.dominance);
  return fit;
}

DominanceStep dominance_step(const RefinedData& data, const DominanceOptions& options,
                             const DominanceFit& fit, bool project) {
  const std::size_t n = data.phones.size() * kPerPhone;
  StepSums zero{std::vector<double>(n), std::vector<double>(n * n), {}};
  if (project) zero.cross.assign(unknowns_of(data) * n * data.controls, 0.0);
  StepSums sums = sum_over(data, zero, [&](const FitSentence& sentence, StepSums& part) {
    StepWorker(data, fit, project).add(SentenceView(data, sentence, fit.dominance), part);
  });
  if (project)
    project_out(solve_base(data, options, fit.dominance).factor, unknowns_of(data), sums.cross,
                data.controls, sums.hessian, n);
  const double prior = options.prior * double(data.prior_controls);
  for (std::size_t p = 0; p < fit.dominance.size(); ++p) {
    const PhoneDominance& d = fit.dominance[p];
    const double off[kPerPhone] = {std::log(d.left / kStartWidth), std::log(d.right / kStartWidth),
                                   std::log(d.strength)};
    for (std::size_t a = 0; a < kPerPhone; ++a) {
      const std::size_t at = p * kPerPhone + a;
      sums.gradient[at] -= prior * off[a];
      sums.hessian[at * n + at] += prior;
    }
  }
  return {std::move(sums.gradient), std::move(sums.hessian)};
}

bool fit_dominance(const RefinedData& data, const DominanceOptions& options, DominanceFit& fit,
                   const std::function<bool(const DominanceFit&)>& accepted) {
  double damping = 1e-2;
  for (int taken = 0; taken < options.max_steps; ++taken) {
    const DominanceStep step = dominance_step(data, options, fit, true);
    double gain = -1;
    for (int attempt = 0; attempt < 8 && gain < 0; ++attempt) {
      DominanceFit trial = start_dominance(data, options, moved(fit.dominance, step, damping));
      const bool fell = trial.objective < fit.objective;
      damping = fell ? std::max(1e-6, damping / 5) : damping * 5;
      if (!fell) continue;
      gain = (fit.objective - trial.objective) / std::max(1e-300, fit.objective);
      fit = std::move(trial);
    }
    if (gain < 0) return true;
    if (!accepted(fit)) return false;
    if (gain < options.tolerance) return true;
  }
  return false;
}

}  // namespace animeme::dam
