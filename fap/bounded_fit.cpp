#include "fap/detail/bounded_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fap/tables.h"

namespace animeme::fap::internal {
namespace {

constexpr int kPriceSteps = 30;
constexpr double kAngleUnit = 1e-5;  // rad
constexpr double kLidsCount = 3;     // the opening of the eye is small but conspicuous
// The width of a mouth distinguishes O and U from A and E, but height has twelve FAPs and width
// four: on heads from files U is 25 % narrower than I with it, 21 % at 1; its FAPs say 28 %.
constexpr double kWidthCounts = 1.5;

static_assert(kLipPairs <= std::size_t(kFirstLowLevel));
constexpr double kOpen = 100;           // FAP units of MNS: lips at this distance need not meet
constexpr double kMeetingCounts = 5.5;  // weight of measured lip distances against FAPs
constexpr double kRelaxed = 4;          // how much more than it is worth a shape may be used
constexpr int kMeetingRounds = 8;

double product(const FapValues& a, const FapValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Lengths of the FAPUs of ICT-FaceKit's head, in its units (about 2 cm).
double length_of(Unit unit, double radian) {
  switch (unit) {
    case Unit::irisd:
      return 0.993 * kLidsCount;
    case Unit::es:
      return 5.903;
    case Unit::ens:
      return 4.821;
    case Unit::mns:
      return 2.120;
    case Unit::mw:
      return 5.070 * kWidthCounts;
    case Unit::angle:
      return radian * kAngleUnit * 1024;
    case Unit::none:
      return 0;
  }
  return 0;
}

FapValues fap_lengths(double radian) {
  FapValues lengths{};
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    lengths[std::size_t(fap)] = length_of(info(fap).unit, radian) / 1024;
  }
  return lengths;
}

}  // namespace

FapValues target_of(const Frame& frame) {
  FapValues target{};
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    target[fap] = frame.mask[fap] ? frame.value[fap] : 0;
  }
  return target;
}

BoundedFit::BoundedFit(std::vector<std::vector<ShapeWeight>> shapes, double ridge,
                       double steadiness, double most, double radian, Lips lips)
    : shapes_(std::move(shapes)),
      ridge_(std::clamp(ridge, 0.0, 1.0)),
      steadiness_(std::clamp(steadiness, 0.0, 1.0)),
      most_(most),
      lips_(std::move(lips)),
      lengths_(fap_lengths(radian)),
      highs_(shapes_.size(), 1.0),
      weights_(shapes_.size(), 0.0) {
  if (!lips_.closing.empty()) lips_.closing.resize(shapes_.size());
  for (std::size_t k = 0; k < kLipPairs; ++k) {
    const double length = lengths_[std::size_t(kLips[k].upper)];
    lips_.at_rest[k] *= length;
    for (LipValues& values : lips_.closing) values[k] *= length;
  }
}

void BoundedFit::set_mask(const Mask& wanted) {
  if (has_gram_ && wanted == mask_) return;
  mask_ = wanted;
  has_gram_ = true;
  const std::size_t n = shapes_.size();
  columns_.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    for (const ShapeWeight& weight : shapes_[i]) {
      columns_[i][std::size_t(weight.fap)] = weight.value;
    }
    columns_[i] = weighed(columns_[i]);
  }
  gram_.assign(n * n, 0.0);
  costs_.assign(n, 0.0);
  FapValues lips{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) gram_[i * n + j] = product(columns_[i], columns_[j]);
    for (std::size_t k = 0; k < kLipPairs; ++k) lips[k] = columns_[i][k];
    costs_[i] = gram_[i * n + i] - product(lips, lips);
  }
}

// Weighted lengths, 0 for FAPs that the mask does not have; the lip distances precede the low-level
// FAPs.
FapValues BoundedFit::weighed(const FapValues& values) const {
  FapValues out{};
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (mask_[fap]) out[fap] = values[fap] * lengths_[fap];
  }
  for (std::size_t k = 0; k < kLipPairs; ++k) {
    const auto upper = std::size_t(kLips[k].upper), lower = std::size_t(kLips[k].lower);
    if (!lips_.always || !mask_[upper] || !mask_[lower]) continue;
    out[k] = lips_.weight * (out[upper] + out[lower]);
  }
  return out;
}

// What each shape would explain of the target.
void BoundedFit::project(const FapValues& target, std::vector<double>& sums) const {
  const FapValues wanted = weighed(target);
  sums.clear();
  for (const FapValues& column : columns_) sums.push_back(product(column, wanted));
}

// `toll` is what any weight costs.
void BoundedFit::descend(const std::vector<double>& wanted, double steadiness, double toll) {
  left_.assign(wanted.begin(), wanted.end());
  for (double& left : left_) left -= toll;
  descend(steadiness);
}

// left_ is what is wanted, with the pull of the frame before in it, less what weights cost.
void BoundedFit::descend(double steadiness) {
  const std::size_t n = shapes_.size();
  matrix_ = gram_;
  for (std::size_t i = 0; i < n; ++i) {
    double& own = matrix_[i * n + i];
    if (own > 0) own += costs_[i] * (ridge_ + steadiness);
  }
  solver_.solve(matrix_, left_, highs_, weights_);
}

// What the weights leave of the face, as a share of it.
double BoundedFit::residual(const FapValues& target) const {
  const FapValues wanted = weighed(target);
  FapValues left = wanted;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (weights_[i] == 0) continue;
    for (std::size_t f = 0; f < left.size(); ++f) left[f] -= weights_[i] * columns_[i][f];
  }
  const double all = product(wanted, wanted);
  return all > 0 ? std::sqrt(product(left, left) / all) : 0;
}

// Which shapes may be used, and how much: what they are worth when each length costs, times
// kRelaxed, less what their opponent is worth. That changes steadily with the face, so a shape that
// comes into use does not jump. A face that these very shapes made, as a capture is, leaves next
// to nothing: it gets them back as they were.
double BoundedFit::choose_few(const std::vector<double>& wanted, double steadiness,
                              double residual) {
  constexpr double kMostToll = 0.25;
  constexpr double kMadeOfThem = 0.03;  // twice of it: by something else
  const double free = std::clamp(2 - residual / kMadeOfThem, 0.0, 1.0);
  highs_.assign(shapes_.size(), 1.0);
  if (free >= 1) return free;
  left_.assign(wanted.begin(), wanted.end());
  for (std::size_t i = 0; i < left_.size(); ++i) {
    const double length = std::sqrt(gram_[i * left_.size() + i]);
    const double most = std::max(kMostToll, sparsity_.least[i]) * length;
    left_[i] -= std::min(sparsity_.least[i], most) * length;
  }
  descend(steadiness);
  std::vector<double>& worth = scratch_;
  worth = weights_;
  for (std::size_t k = 0; k < sparsity_.opponents.size(); ++k) {
    if (sparsity_.keeps[k]) continue;
    const auto& [a, b] = sparsity_.opponents[k];
    const double both = std::min(weights_[a], weights_[b]);
    worth[a] = std::min(worth[a], weights_[a] - both);
    worth[b] = std::min(worth[b], weights_[b] - both);
  }
  for (std::size_t i = 0; i < worth.size(); ++i) {
    if (sparsity_.least[i] <= 0) continue;
    const double relaxed =
        sparsity_.least[i] > kMostToll ? 1 : kRelaxed;  // a mood is not made of little
    highs_[i] = std::max(free, std::clamp(relaxed * worth[i], 0.0, 1.0));
  }
  return free;
}

// Of opponents of which the first one keeps what it has beside the second one: what that does is
// taken off the face, with it. `free`: of choose_few().
void BoundedFit::part_keepers(std::vector<double>& wanted, double steadiness, double free) {
  bool any = false;
  for (std::size_t k = 0; k < sparsity_.opponents.size(); ++k) {
    const auto& [first, second] = sparsity_.opponents[k];
    const double one = weights_[first], other = weights_[second];
    const double both = std::min(one, other);
    if (!sparsity_.keeps[k] || both <= 0) continue;
    any = true;
    if (other > one) {
      highs_[first] =
          std::min(highs_[first], std::max(free, std::max(one - kRelaxed * (other - one), 0.0)));
    }
    highs_[second] =
        std::min(highs_[second], std::max(free, std::clamp(kRelaxed * (other - both), 0.0, 1.0)));
    const double gone = std::max(other - highs_[second], 0.0);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      wanted[i] -= gone * gram_[i * wanted.size() + second];
    }
  }
  if (any) descend(wanted, steadiness, 0);
}

// Where measured lips do not meet as they should, their distances join the sum of squares; one that
// is there pulls towards meeting only, so lips that press each other already stay as they are.
void BoundedFit::close_lips(const std::vector<double>& wanted, const FapValues& target,
                            double steadiness) {
  const std::size_t n = shapes_.size();
  LipValues goal{}, pull{};  // closing, and its weight, squared
  for (std::size_t k = 0; k < kLipPairs; ++k) {
    const auto upper = std::size_t(kLips[k].upper), lower = std::size_t(kLips[k].lower);
    if (!mask_[upper] || !mask_[lower]) continue;
    const double closing = target[upper] + target[lower];
    const double weight = kMeetingCounts * lips_.weight * std::clamp(1 + closing / kOpen, 0.0, 1.0);
    const double meant = lips_.always ? soft_closing(closing) : closing;
    goal[k] = std::min(meant * lengths_[upper], lips_.at_rest[k]);
    pull[k] = weight * weight;
  }
  std::array<bool, kLipPairs> joined{};
  for (int round = 0; round < kMeetingRounds; ++round) {
    std::array<bool, kLipPairs> apart{};
    for (std::size_t k = 0; k < kLipPairs; ++k) {
      double closing = 0;
      for (std::size_t i = 0; i < n; ++i) closing += weights_[i] * lips_.closing[i][k];
      apart[k] = pull[k] > 0 && closing < goal[k];
    }
    if (apart == joined) break;
    joined = apart;
    if (round == 0) fap_gram_ = gram_;
    gram_ = fap_gram_;
    std::vector<double>& sums = scratch_;
    sums = wanted;
    for (std::size_t k = 0; k < kLipPairs; ++k) {
      for (std::size_t i = 0; i < n && joined[k]; ++i) {
        if (fap_gram_[i * n + i] <= 0) continue;  // it would cost nothing
        const double share = pull[k] * lips_.closing[i][k];
        for (std::size_t j = 0; j < n; ++j) gram_[i * n + j] += share * lips_.closing[j][k];
        sums[i] += share * goal[k];
      }
    }
    descend(sums, steadiness, 0);
  }
  if (!fap_gram_.empty()) gram_.swap(fap_gram_);
  fap_gram_.clear();
}

// The limit of the sum as a price on all weights: the lowest one that keeps it.
void BoundedFit::keep_within_limit(const std::vector<double>& wanted, double steadiness) {
  const auto sum = [this] { return std::accumulate(weights_.begin(), weights_.end(), 0.0); };
  if (!(sum() > most_)) return;
  double low = 0;
  double high = *std::max_element(wanted.begin(), wanted.end());  // nothing is used at that
  for (int step = 0; step < kPriceSteps; ++step) {
    const double middle = (low + high) / 2;
    descend(wanted, steadiness, middle);
    (sum() > most_ ? low : high) = middle;
  }
  descend(wanted, steadiness, high);
  const double over = sum() / most_;  // what the last digits of the price leave
  for (double& weight : weights_) weight /= std::max(1.0, over);
}

void BoundedFit::restart() {
  std::fill(weights_.begin(), weights_.end(), 0.0);
  is_first_ = true;
}

const std::vector<double>& BoundedFit::fit(const Mask& mask, const FapValues& target) {
  set_mask(mask);
  std::vector<double>& wanted = wanted_;
  project(target, wanted);
  const double steadiness = is_first_ ? 0 : steadiness_;
  is_first_ = false;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i] += steadiness * costs_[i] * weights_[i];
  }
  descend(wanted, steadiness, 0);
  if (!sparsity_.least.empty()) {
    const double free = choose_few(wanted, steadiness, residual(target));
    descend(wanted, steadiness, 0);
    if (free < 1) part_keepers(wanted, steadiness, free);
  }
  if (!lips_.closing.empty()) close_lips(wanted, target, steadiness);
  keep_within_limit(wanted, steadiness);
  return weights_;
}

}  // namespace animeme::fap::internal
