// FAPs to ARKit: a bounded least squares fit, and closed-form channels.
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <vector>

#include "fap/arkit.h"
#include "fap/arkit_internal.h"
#include "fap/detail/face_fit.h"

namespace animeme::fap {
namespace {

using internal::arkit_weights;
using internal::ArkitWeight;

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

// The distance of the lips beside the FAPs that make it: without it, one of three closed P B M of
// the sample comes back as closed, at 1 all but one of 39; at 2 faces are seen to be less alike.
constexpr double kMeetingOfShapes = 1;

// Their channels, looked up once.
const std::array<std::size_t, std::size(kDirect)>& direct_channels() {
  static const auto all = [] {
    std::array<std::size_t, std::size(kDirect)> made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      made[i] = std::size_t(find_arkit(kDirect[i].channel).value_or(0));
    }
    return made;
  }();
  return all;
}

double effect(std::size_t channel, int fap) {
  for (const ArkitWeight& weight : arkit_weights()[channel]) {
    if (weight.fap == fap) return weight.value;
  }
  return 0;
}

}  // namespace

struct ArkitFitter::Impl {
  std::vector<std::size_t> shapes;  // those that are fitted, by channel
  internal::FaceFit fit;
};

namespace {

// Channels of shapes that are not found one by one.
std::vector<std::size_t> fitted_shapes() {
  std::vector<std::size_t> shapes;
  for (std::size_t channel = 0; channel < kArkitShapeCount; ++channel) {
    const auto same = [&](const Direct& direct) { return direct.channel == kArkitNames[channel]; };
    if (std::none_of(std::begin(kDirect), std::end(kDirect), same)) shapes.push_back(channel);
  }
  return shapes;
}

std::vector<std::vector<ArkitWeight>> weights_of(const std::vector<std::size_t>& shapes) {
  std::vector<std::vector<ArkitWeight>> weights;
  for (const std::size_t channel : shapes) weights.push_back(arkit_weights()[channel]);
  return weights;
}

// What the shapes do to the distance of the lips.
internal::Lips lips_of(const std::vector<std::vector<ArkitWeight>>& weights) {
  internal::Lips lips{kMeetingOfShapes, {}, {}, false};
  lips.at_rest.fill(std::numeric_limits<double>::max());
  for (const std::vector<ArkitWeight>& shape : weights) {
    internal::LipValues& closing = lips.closing.emplace_back();
    for (const ArkitWeight& weight : shape) {
      for (std::size_t k = 0; k < internal::kLipPairs; ++k) {
        const internal::LipPair& pair = internal::kLips[k];
        if (weight.fap == pair.upper || weight.fap == pair.lower) closing[k] += weight.value;
      }
    }
  }
  return lips;
}

internal::FaceFit fit_of(const ArkitFitOptions& options) {
  const std::vector<std::size_t> shapes = fitted_shapes();
  const auto weights = weights_of(shapes);
  return {weights,
          std::vector<std::optional<int>>(shapes.begin(), shapes.end()),
          {options.ridge, options.steadiness, options.sparsity},
          lips_of(weights)};
}

}  // namespace

ArkitFitter::ArkitFitter(const ArkitFitOptions& options)
    : impl_(new Impl{fitted_shapes(), fit_of(options)}) {}
ArkitFitter::ArkitFitter(ArkitFitter&&) noexcept = default;
ArkitFitter& ArkitFitter::operator=(ArkitFitter&&) noexcept = default;
ArkitFitter::~ArkitFitter() = default;

ArkitFrame ArkitFitter::fit(const Frame& frame) {
  ArkitFrame out{};
  std::array<double, 2> looks_down{};
  internal::FapValues target = internal::target_of(frame);
  for (std::size_t d = 0; d < std::size(kDirect); ++d) {
    const Direct& direct = kDirect[d];
    if (!frame.mask[std::size_t(direct.fap)]) continue;
    const std::size_t channel = direct_channels()[d];
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
  static const std::size_t kDown[] = {std::size_t(find_arkit("eyeLookDownLeft").value_or(0)),
                                      std::size_t(find_arkit("eyeLookDownRight").value_or(0))};
  for (std::size_t side = 0; side < 2; ++side) looks_down[side] = out[kDown[side]];
  const std::vector<double>& weights = impl_->fit.fit(frame, target, looks_down);
  for (std::size_t i = 0; i < impl_->shapes.size(); ++i) out[impl_->shapes[i]] = weights[i];
  return out;
}

}  // namespace animeme::fap
