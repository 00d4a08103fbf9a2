#include "fap/detail/exact_fit.h"

#include <algorithm>
#include <cmath>

namespace animeme::fap::internal {
namespace {

constexpr double kRounding = 0.3;     // units: the standard deviation of rounding to whole ones
constexpr double kUsualWeight = 0.3;  // likewise of weights
constexpr double kRoundedOff = 2;     // units: the most that rounding of all shapes' FAPs leaves
constexpr double kMadeOfThem = 0.03;  // of a face; from twice of it on something else made it
constexpr double kTogether = 0.03;    // opposites may both have this weight
constexpr double kAsWell = 0.5;       // units by which the worst FAP may be off more

}  // namespace

ExactFit::ExactFit(const std::vector<std::vector<ShapeWeight>>& shapes,
                   std::vector<Opponents> opposites, std::vector<Opponents> never)
    : opposites_(std::move(opposites)),
      never_(std::move(never)),
      highs_(shapes.size(), 1.0),
      weights_(shapes.size(), 0.0) {
  for (const std::vector<ShapeWeight>& shape : shapes) {
    FapValues& column = columns_.emplace_back();
    for (const ShapeWeight& weight : shape) column[std::size_t(weight.fap)] = weight.value;
  }
}

void ExactFit::set_mask(const Mask& mask) {
  if (has_gram_ && mask == mask_) return;
  mask_ = mask;
  has_gram_ = true;
  const std::size_t n = columns_.size();
  gram_.assign(n * n, 0);
  kept_.resize(n);  // now, so that no later frame allocates
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (std::size_t f = kFirstLowLevel; f <= kFapCount; ++f) {
        if (mask_[f]) sum += columns_[i][f] * columns_[j][f];
      }
      gram_[i * n + j] = gram_[j * n + i] = sum;
    }
  }
}

void ExactFit::solve(double rest) {
  const std::size_t n = columns_.size();
  matrix_ = gram_;
  for (std::size_t i = 0; i < n; ++i) {
    if (gram_[i * n + i] > 0) matrix_[i * n + i] += rest;
  }
  solver_.solve(matrix_, wanted_, highs_, weights_);
}

ExactFit::Left ExactFit::left_of(const FapValues& target) const {
  FapValues off = target;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (weights_[i] == 0) continue;
    for (std::size_t f = kFirstLowLevel; f <= kFapCount; ++f)
      off[f] -= weights_[i] * columns_[i][f];
  }
  Left left;
  for (std::size_t f = kFirstLowLevel; f <= kFapCount; ++f) {
    if (!mask_[f]) continue;
    left.worst = std::max(left.worst, std::abs(off[f]));
    left.squares += off[f] * off[f];
    if (!is_lid_or_brow(int(f))) left.below += off[f] * off[f];
  }
  return left;
}

// Of two that are never together that which leaves less; a twentieth of the other is no matter.
ExactFit::Left ExactFit::use_one_of_lids(const FapValues& target, double rest, Left left) {
  constexpr double kUnseen = 0.05;
  for (const auto& [a, b] : never_) {
    const double both = std::min(weights_[a], weights_[b]);
    if (both <= 0 || (both <= kUnseen && left.worst <= kRoundedOff)) continue;
    highs_[a] = 0;
    solve(rest);
    const Left without_a = left_of(target);
    kept_ = weights_;
    highs_[a] = 1;
    highs_[b] = 0;
    solve(rest);
    left = left_of(target);
    if (left.squares <= without_a.squares) continue;
    highs_[b] = 1;
    highs_[a] = 0;
    weights_ = kept_;
    left = without_a;
  }
  return left;
}

// Of two that undo each other the lesser one is left out, else the other, if the face is explained
// as well.
ExactFit::Left ExactFit::use_one_of_opposites(const FapValues& target, double rest, Left left) {
  for (const auto& [a, b] : opposites_) {
    if (std::min(weights_[a], weights_[b]) <= kTogether) continue;
    kept_ = weights_;
    const bool first_is_less = weights_[a] < weights_[b];
    bool done = false;
    for (const std::size_t out : {first_is_less ? a : b, first_is_less ? b : a}) {
      highs_[out] = kTogether;
      solve(rest);
      const Left now = left_of(target);
      done = now.worst <= std::max(left.worst, kRounding) + kAsWell ||
             now.squares <= 1.1 * left.squares;
      if (done) {
        left = now;
        break;
      }
      highs_[out] = 1;
    }
    if (!done) weights_ = kept_;
  }
  return left;
}

const std::vector<double>& ExactFit::fit(const Mask& mask, const FapValues& target) {
  set_mask(mask);
  const std::size_t n = columns_.size();
  wanted_.assign(n, 0);
  double all = 0, below = 0;
  std::size_t count = 0;
  for (std::size_t f = kFirstLowLevel; f <= kFapCount; ++f) {
    if (!mask_[f]) continue;
    ++count;
    all += target[f] * target[f];
    if (!is_lid_or_brow(int(f))) below += target[f] * target[f];
    for (std::size_t i = 0; i < n; ++i) wanted_[i] += columns_[i][f] * target[f];
  }
  std::fill(weights_.begin(), weights_.end(), 0.0);
  std::fill(highs_.begin(), highs_.end(), 1.0);
  const auto cost = [](double noise) { return noise * noise / (kUsualWeight * kUsualWeight); };
  double rest = cost(kRounding);
  solve(rest);
  Left left = left_of(target);
  // Coarser steps, as a stream has, leave less that is certain.
  const double noise = count > 0 ? std::sqrt(left.squares / double(count)) : 0;
  if (left.worst > kRoundedOff && noise > kRounding) {
    rest = cost(noise);
    solve(rest);
    left = left_of(target);
  }
  left = use_one_of_lids(target, rest, left);
  left = use_one_of_opposites(target, rest, left);
  // A blink is so large that the rest would seem to be made of the shapes whatever it is: the lips
  // of a P would part while the eyes are closed.
  double share = all > 0 ? std::sqrt(left.squares / all) : 0;
  if (below > 0) share = std::max(share, std::sqrt(left.below / below));
  certainty_ = left.worst <= kRoundedOff ? 1 : std::clamp(2 - share / kMadeOfThem, 0.0, 1.0);
  return weights_;
}

}  // namespace animeme::fap::internal
