// FAPs to ARKit: a least squares fit with bounds, by coordinate descent.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fap/arkit.h"
#include "fap/arkit_internal.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

using internal::arkit_weights;
using internal::ArkitWeight;

constexpr int kMostSweeps = 5000;
constexpr double kStill = 1e-6;   // a weight that changes less has arrived
constexpr double kLidsCount = 3;  // the opening of the eye is short and everybody looks at it

// Lengths of the FAPUs on the head that the table was measured on, in its units (about 2 cm).
double length_of(Unit unit) {
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
      return 5.070;
    case Unit::angle:
    case Unit::none:
      return 0;
  }
  return 0;
}

// Eyes, head and tongue: found one by one, not by the fit.
struct Direct {
  std::string_view channel;
  int fap;
};

constexpr Direct kDirect[] = {
    {"eyeLookOutLeft", 23},   {"eyeLookInLeft", 23},   {"eyeLookOutRight", 24},
    {"eyeLookInRight", 24},   {"eyeLookDownLeft", 25}, {"eyeLookUpLeft", 25},
    {"eyeLookDownRight", 26}, {"eyeLookUpRight", 26},  {"headYaw", 49},
    {"headPitch", 48},        {"headRoll", 50},        {"leftEyeYaw", 23},
    {"leftEyePitch", 25},     {"rightEyeYaw", 24},     {"rightEyePitch", 26},
    {"tongueOut", 45}};

double effect(std::size_t channel, int fap) {
  for (const ArkitWeight& weight : arkit_weights()[channel]) {
    if (weight.fap == fap) return weight.value;
  }
  return 0;
}

}  // namespace

struct ArkitFitter::Impl {
  ArkitFitOptions options;
  std::vector<std::size_t> shapes;  // those that are fitted, by channel
  std::vector<double> gram;         // shapes x shapes, for `mask`
  Mask mask;
  bool has_gram = false;
  std::vector<double> weights;  // of the frame before
  bool is_first = true;

  explicit Impl(const ArkitFitOptions& given);
  void set_mask(const Mask& wanted);
  std::vector<double> projections(const std::array<double, kFapCount + 1>& target) const;
  void descend(const std::vector<double>& wanted);
};

namespace {

std::array<double, kFapCount + 1> fap_lengths() {
  std::array<double, kFapCount + 1> lengths{};
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    lengths[std::size_t(fap)] = length_of(info(fap).unit) / 1024;
  }
  return lengths;
}

const std::array<double, kFapCount + 1>& lengths() {
  static const auto all = fap_lengths();
  return all;
}

}  // namespace

ArkitFitter::Impl::Impl(const ArkitFitOptions& given) : options(given) {
  options.ridge = std::clamp(options.ridge, 0.0, 1.0);
  options.steadiness = std::clamp(options.steadiness, 0.0, 1.0);
  for (std::size_t channel = 0; channel < kArkitShapeCount; ++channel) {
    const auto same = [&](const Direct& direct) { return direct.channel == kArkitNames[channel]; };
    if (std::none_of(std::begin(kDirect), std::end(kDirect), same)) shapes.push_back(channel);
  }
  weights.assign(shapes.size(), 0.0);
}

void ArkitFitter::Impl::set_mask(const Mask& wanted) {
  if (has_gram && wanted == mask) return;
  mask = wanted;
  has_gram = true;
  const std::size_t n = shapes.size();
  std::vector<std::array<double, kFapCount + 1>> columns(n);
  for (std::size_t i = 0; i < n; ++i) {
    columns[i].fill(0);
    for (const ArkitWeight& weight : arkit_weights()[shapes[i]]) {
      const std::size_t fap = std::size_t(weight.fap);
      if (mask[fap]) columns[i][fap] = weight.value * lengths()[fap];
    }
  }
  gram.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
        gram[i * n + j] += columns[i][fap] * columns[j][fap];
      }
    }
  }
}

// What each shape would explain of the target.
std::vector<double> ArkitFitter::Impl::projections(
    const std::array<double, kFapCount + 1>& target) const {
  std::vector<double> sums(shapes.size(), 0.0);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (const ArkitWeight& weight : arkit_weights()[shapes[i]]) {
      const std::size_t fap = std::size_t(weight.fap);
      if (!mask[fap]) continue;
      sums[i] += weight.value * lengths()[fap] * target[fap] * lengths()[fap];
    }
  }
  return sums;
}

void ArkitFitter::Impl::descend(const std::vector<double>& wanted) {
  const std::size_t n = shapes.size();
  const std::vector<double> before = weights;
  const double steadiness = is_first ? 0 : options.steadiness;
  is_first = false;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double own = gram[i * n + i];
      if (own <= 0) continue;  // the frame has none of its FAPs: it stays as it is
      double left = wanted[i] + steadiness * own * before[i];
      for (std::size_t j = 0; j < n; ++j) {
        if (j != i) left -= gram[i * n + j] * weights[j];
      }
      const double best = std::clamp(left / (own * (1 + options.ridge + steadiness)), 0.0, 1.0);
      largest = std::max(largest, std::abs(best - weights[i]));
      weights[i] = best;
    }
    if (largest < kStill) return;
  }
}

ArkitFitter::ArkitFitter(const ArkitFitOptions& options) : impl_(std::make_unique<Impl>(options)) {}
ArkitFitter::ArkitFitter(ArkitFitter&&) noexcept = default;
ArkitFitter& ArkitFitter::operator=(ArkitFitter&&) noexcept = default;
ArkitFitter::~ArkitFitter() = default;

ArkitFrame ArkitFitter::fit(const Frame& frame) {
  ArkitFrame out{};
  std::array<double, kFapCount + 1> target{};
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    target[fap] = frame.mask[fap] ? frame.value[fap] : 0;
  }
  for (const Direct& direct : kDirect) {
    if (!frame.mask[std::size_t(direct.fap)]) continue;
    const auto channel = std::size_t(find_arkit(direct.channel).value_or(0));
    const double full = effect(channel, direct.fap);
    const double value = frame.value[std::size_t(direct.fap)];
    const bool angle = channel >= kArkitShapeCount;
    out[channel] = angle ? value / full : std::clamp(value / full, 0.0, 1.0);
    if (angle) continue;
    // The shapes of the gaze take the lids along.
    for (const ArkitWeight& weight : arkit_weights()[channel]) {
      target[std::size_t(weight.fap)] -= out[channel] * weight.value;
    }
  }
  impl_->set_mask(frame.mask);
  impl_->descend(impl_->projections(target));
  for (std::size_t i = 0; i < impl_->shapes.size(); ++i) out[impl_->shapes[i]] = impl_->weights[i];
  return out;
}

}  // namespace animeme::fap
