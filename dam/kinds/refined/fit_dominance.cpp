// Gauss-Newton for the dominance, the base curves being re-fitted to first order at every step
// (variable projection, Kaufman's form).
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "dam/kinds/refined/base_curves.h"
#include "dam/kinds/refined/dominance.h"
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
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  RowMatrix cross;  // (unknowns x parameters) by controls: X^T J

  StepSums& operator+=(const StepSums& o) {
    gradient += o.gradient;
    hessian += o.hessian;
    cross += o.cross;
    return *this;
  }
};

class StepWorker {
 public:
  StepWorker(const RefinedData& data, const DominanceFit& fit, bool project)
      : data_(data), fit_(fit), project_(project), k_(Eigen::Index(data.controls)) {}

  void add(const SentenceView& view, StepSums& sums) {
    const auto parameters = sums.gradient.size();
    const auto unknowns = Eigen::Index(unknowns_of(data_));
    RowMatrix slope_sum = RowMatrix::Zero(parameters, k_);
    Eigen::RowVectorXd residual_sum = Eigen::RowVectorXd::Zero(k_);
    Eigen::VectorXd column_sum = Eigen::VectorXd::Zero(unknowns);
    for (const std::size_t i : view.used()) {
      const std::span<const RefinedPart> parts = view.parts(i);
      const Row residual = linearise(view, i);
      residual_sum += residual.matrix();
      for (std::size_t p = 0; p < parts.size(); ++p) {
        add_slope_products(parts, p, residual, slope_sum, sums);
        for (std::size_t m = 0; m < kRefinedOrders; ++m)
          column_sum[Eigen::Index(parts[p].phone * kRefinedOrders + m)] +=
              parts[p].weight * parts[p].basis[m];
      }
    }
    const double share = 1 / view.offset();
    sums.gradient.noalias() -= share * slope_sum * residual_sum.transpose();
    sums.hessian.noalias() -= share * slope_sum * slope_sum.transpose();
    if (!project_) return;
    for (Eigen::Index u = 0; u < unknowns; ++u)
      if (column_sum[u] != 0)
        sums.cross.middleRows(u * parameters, parameters) -= share * column_sum[u] * slope_sum;
  }

 private:
  /// Residual of a frame; slopes_ become w (A - C) of its parts.
  Row linearise(const SentenceView& view, std::size_t i) {
    const std::span<const RefinedPart> parts = view.parts(i);
    if (slopes_.size() < parts.size()) slopes_.resize(parts.size(), Row(k_));
    Row blend = Row::Zero(k_);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Row& value = slopes_[p];
      value = Row::Zero(k_);
      for (std::size_t m = 0; m < kRefinedOrders; ++m)
        value += parts[p].basis[m] *
                 Eigen::Map<const Row>(
                     &fit_.base[(parts[p].phone * kRefinedOrders + m) * data_.controls], k_);
      blend += parts[p].weight * value;
    }
    for (std::size_t p = 0; p < parts.size(); ++p)
      slopes_[p] = parts[p].weight * (slopes_[p] - blend);
    return view.target(i) - blend;
  }

  void add_slope_products(std::span<const RefinedPart> parts, std::size_t p, const Row& residual,
                          RowMatrix& slope_sum, StepSums& sums) const {
    double fp[kPerPhone], fq[kPerPhone];
    factors(parts[p], fp);
    const auto at = [&](std::size_t part) { return Eigen::Index(parts[part].phone * kPerPhone); };
    const double along = (slopes_[p] * residual).sum();
    for (std::size_t a = 0; a < kPerPhone; ++a) {
      sums.gradient[at(p) + Eigen::Index(a)] += fp[a] * along;
      if (fp[a] != 0) slope_sum.row(at(p) + Eigen::Index(a)).array() += fp[a] * slopes_[p];
    }
    for (std::size_t q = 0; q < parts.size(); ++q) {
      const double both = (slopes_[p] * slopes_[q]).sum();
      factors(parts[q], fq);
      for (std::size_t a = 0; a < kPerPhone; ++a)
        for (std::size_t b = 0; b < kPerPhone; ++b)
          sums.hessian(at(p) + Eigen::Index(a), at(q) + Eigen::Index(b)) += fp[a] * fq[b] * both;
    }
    if (!project_) return;
    const auto parameters = sums.gradient.size();
    for (const RefinedPart& x : parts)
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double w = x.weight * x.basis[m];
        const auto unknown = Eigen::Index(x.phone * kRefinedOrders + m);
        for (std::size_t a = 0; a < kPerPhone; ++a)
          if (fp[a] != 0)
            sums.cross.row(unknown * parameters + at(p) + Eigen::Index(a)).array() +=
                w * fp[a] * slopes_[p];
      }
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
  Eigen::Index k_;
  std::vector<Row> slopes_;
};

std::vector<PhoneDominance> moved(std::span<const PhoneDominance> from, const DominanceStep& step,
                                  double damping) {
  const Eigen::VectorXd delta = damped_step(step.gradient, step.hessian, damping);
  std::vector<PhoneDominance> to(from.begin(), from.end());
  for (std::size_t p = 0; p < to.size(); ++p) {
    const auto by = [&](std::size_t a) { return delta[Eigen::Index(p * kPerPhone + a)]; };
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
  fit.base.assign(base.curves.data(), base.curves.data() + base.curves.size());
  fit.objective = base.objective + prior_of(data, options, fit.dominance);
  return fit;
}

DominanceStep dominance_step(const RefinedData& data, const DominanceOptions& options,
                             const DominanceFit& fit, bool project) {
  const std::size_t parameters = data.phones.size() * kPerPhone;
  const auto n = Eigen::Index(parameters);
  StepSums zero{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n), {}};
  if (project)
    zero.cross = RowMatrix::Zero(Eigen::Index(unknowns_of(data)) * n, Eigen::Index(data.controls));
  StepSums sums = sum_over(data, zero, [&](const FitSentence& sentence, StepSums& part) {
    StepWorker(data, fit, project).add(SentenceView(data, sentence, fit.dominance), part);
  });
  if (project)
    project_out(solve_base(data, options, fit.dominance).factor, sums.cross, sums.hessian);
  const double prior = options.prior * double(data.prior_controls);
  for (std::size_t p = 0; p < fit.dominance.size(); ++p) {
    const PhoneDominance& d = fit.dominance[p];
    const double off[kPerPhone] = {std::log(d.left / kStartWidth), std::log(d.right / kStartWidth),
                                   std::log(d.strength)};
    for (std::size_t a = 0; a < kPerPhone; ++a) {
      const auto at = Eigen::Index(p * kPerPhone + a);
      sums.gradient[at] -= prior * off[a];
      sums.hessian(at, at) += prior;
    }
  }
  return {{sums.gradient.data(), sums.gradient.data() + n},
          {sums.hessian.data(), sums.hessian.data() + n * n}};
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
