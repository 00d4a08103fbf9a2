// Sparse fits: plain least squares uses small weights of forty shapes, some of which cancel each
// other, for a negligible improvement. On 240 clips of grid_s1 with weights of another tracker, the
// sparse weights agree better with these: jawOpen correlates by 0.79 instead of 0.74, mouthPucker
// by 0.76 instead of 0.39, and 5.8 shapes are in use instead of 15.5 (800 frames, depth left out).
#include "fap/detail/arkit_sparsity.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "fap/arkit.h"
#include "fap/shape_fit.h"

namespace animeme::fap::internal {
namespace {

// Shapes that undo each other, the first of each pair with the second.
constexpr std::pair<std::string_view, std::string_view> kOpponents[] = {
    {"jawLeft", "jawRight"},
    {"mouthLeft", "mouthRight"},
    {"mouthSmileLeft", "mouthFrownLeft"},
    {"mouthSmileRight", "mouthFrownRight"},
    {"mouthPucker", "cheekPuff"},
    {"mouthPucker", "mouthFrownLeft"},
    {"mouthPucker", "mouthFrownRight"},
    {"mouthRollUpper", "mouthUpperUpLeft"},
    {"mouthRollUpper", "mouthUpperUpRight"},
    {"mouthRollLower", "mouthLowerDownLeft"},
    {"mouthRollLower", "mouthLowerDownRight"},
    {"mouthPucker", "mouthStretchLeft"},
    {"mouthPucker", "mouthStretchRight"},
    {"mouthFunnel", "mouthRollUpper"},
    {"mouthFunnel", "mouthRollLower"},
    {"mouthPressLeft", "mouthUpperUpLeft"},
    {"mouthPressRight", "mouthUpperUpRight"},
    {"mouthPressLeft", "mouthLowerDownLeft"},
    {"mouthPressRight", "mouthLowerDownRight"},
    {"eyeBlinkLeft", "eyeWideLeft"},
    {"eyeBlinkRight", "eyeWideRight"}};

// Lips that round go forward more than ARKit's pucker does for the width that it takes off, so that
// the corners would keep it from rounding them: recorded U would be a third less round.
constexpr std::string_view kKeepsRound = "mouthPucker", kSpreads = "mouthStretch";

// What people hardly do when they speak.
constexpr std::string_view kSeldom[] = {"mouthFrown",  "mouthLeft",  "mouthRight", "jawLeft",
                                        "jawRight",    "jawForward", "cheekPuff",  "mouthShrug",
                                        "mouthDimple", "noseSneer",  "cheekSquint"};
constexpr double kLeast = 0.02;      // of Sparsity: 0.2 mm
constexpr double kHardlyAny = 1e-6;  // likewise, for shapes that have an opponent
constexpr double kLeastOfSeldom = 0.15;
constexpr double kLeastOfMoods = 0.6;  // pressed lips alone are no anger

int channel_of(std::string_view name) { return find_arkit(name).value_or(0); }

double least_of(std::string_view name) {
  if (name == "mouthClose") return 0;  // what P, B and M need
  const bool seldom = std::any_of(std::begin(kSeldom), std::end(kSeldom),
                                  [&](auto start) { return name.starts_with(start); });
  return seldom ? kLeastOfSeldom : kLeast;
}

// What the names above say, by channel: looked up once, since heads ask for it in every frame.
struct ByChannel {
  int jaw = channel_of("jawOpen");
  std::array<double, kArkitChannelCount> least = {};
  std::vector<std::pair<int, int>> opponents;
  std::vector<bool> keeps, always;
};

// Those that undo each other whatever opens the mouth.
bool is_always(std::string_view one, std::string_view other) {
  return other.starts_with(kSpreads) || one == "jawLeft" || one == "mouthLeft" ||
         one.starts_with("mouthSmile") || one.starts_with("eyeBlink");
}

const ByChannel& by_channel() {
  static const ByChannel all = [] {
    ByChannel made;
    for (std::size_t c = 0; c < made.least.size(); ++c) made.least[c] = least_of(kArkitNames[c]);
    for (const auto& [one, other] : kOpponents) {
      made.opponents.emplace_back(channel_of(one), channel_of(other));
      made.keeps.push_back(one == kKeepsRound && other.starts_with(kSpreads));
      made.always.push_back(is_always(one, other));
    }
    return made;
  }();
  return all;
}

}  // namespace

Sparsity sparsity_of(std::span<const std::optional<int>> channels, double share) {
  Sparsity sparsity;
  if (!(share > 0)) return sparsity;
  const auto place = [&](int channel) {
    return std::size_t(std::find(channels.begin(), channels.end(), channel) - channels.begin());
  };
  // Where visemes open the mouth, all that is left of ARKit may be needed to put them right.
  const ByChannel& names = by_channel();
  const bool jaw = place(names.jaw) < channels.size();
  for (const std::optional<int>& channel : channels) {
    const double least = !channel                 ? 0
                         : *channel == kWholeFace ? kLeastOfMoods
                         : jaw                    ? names.least[std::size_t(*channel)]
                                                  : 0;
    sparsity.least.push_back(share * least);
  }
  for (std::size_t i = 0; i < names.opponents.size(); ++i) {
    const std::size_t a = place(names.opponents[i].first), b = place(names.opponents[i].second);
    if (std::max(a, b) >= channels.size() || (!jaw && !names.always[i])) continue;
    for (const std::size_t shape : {a, b}) {
      sparsity.least[shape] = std::max(sparsity.least[shape], share * kHardlyAny);
    }
    sparsity.opponents.push_back({a, b});
    sparsity.keeps.push_back(names.keeps[i]);
  }
  return sparsity;
}

Mask without_unmeasured(const Frame& frame) {
  Mask mask = frame.mask;
  for (const std::size_t fap : {14, 18, 39, 40, 41, 42}) {
    if (frame.value[fap] == 0) mask.reset(fap);
  }
  return mask;
}

}  // namespace animeme::fap::internal
