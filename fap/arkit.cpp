#include "fap/arkit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fap/arkit_internal.h"
#include "fap/detail/symmetry.h"
#include "fap/detail/text_scanner.h"
#include "fap/tables.h"

namespace animeme::fap {

namespace {

// By number.
constexpr std::string_view kNames =
    "eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft "
    "eyeWideLeft eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight eyeLookUpRight "
    "eyeSquintRight eyeWideRight jawForward jawRight jawLeft jawOpen mouthClose mouthFunnel "
    "mouthPucker mouthRight mouthLeft mouthSmileLeft mouthSmileRight mouthFrownLeft "
    "mouthFrownRight mouthDimpleLeft mouthDimpleRight mouthStretchLeft mouthStretchRight "
    "mouthRollLower mouthRollUpper mouthShrugLower mouthShrugUpper mouthPressLeft mouthPressRight "
    "mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft mouthUpperUpRight browDownLeft "
    "browDownRight browInnerUp browOuterUpLeft browOuterUpRight cheekPuff cheekSquintLeft "
    "cheekSquintRight noseSneerLeft noseSneerRight tongueOut headYaw headPitch headRoll "
    "leftEyeYaw leftEyePitch leftEyeRoll rightEyeYaw rightEyePitch rightEyeRoll";

constexpr std::array<std::string_view, kArkitChannelCount> split_names() {
  std::array<std::string_view, kArkitChannelCount> names;
  std::string_view rest = kNames;
  for (std::string_view& name : names) {
    name = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
  }
  return names;
}

}  // namespace

constinit const std::array<std::string_view, kArkitChannelCount> kArkitNames = split_names();

namespace {

using internal::ArkitWeight;

constexpr int kLidsMeet = 1024;  // FAP 19 + 21: IRISD is the opening of the lids
constexpr std::size_t kLongestName = 200;
constexpr std::size_t kFirstEyeball = 23, kLastEyeball = 26;

std::array<std::string, kArkitChannelCount> lower_case_names() {
  std::array<std::string, kArkitChannelCount> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = detail::lower_case(kArkitNames[i]);
  return names;
}

// Letters and digits in lower case, with the side spelled out: "Eye_Blink_L" is "eyeblinkleft".
std::string plain_name(std::string_view name) {
  std::string lower = detail::lower_case(name);
  for (const auto& [ending, side] : {std::pair("l", "left"), {"r", "right"}}) {
    const std::size_t n = lower.size();
    if (n > 2 && lower.ends_with(ending) &&
        std::string_view("_. -").find(lower[n - 2]) != std::string_view::npos) {
      lower.replace(n - 2, 2, side);
      break;
    }
  }
  std::erase_if(lower, [](char c) { return c == '_' || c == '.' || c == ' ' || c == '-'; });
  return lower;
}

// The places in a name where the name of a shape may begin: after what programs put before it
// ("blendShapes.JawOpen", "head_lod0_mesh__jawOpen").
std::vector<std::size_t> beginnings_of(std::string_view name) {
  std::vector<std::size_t> at = {0};
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    const bool twice = i > 0 && name[i] == '_' && name[i - 1] == '_';
    if (twice || std::string_view(".:|/").find(name[i]) != std::string_view::npos)
      at.push_back(i + 1);
  }
  return at;
}

ArkitWeight mirrored(const ArkitWeight& weight) {
  const internal::MirrorImage image = internal::mirror_image(weight.fap);
  return {image.fap, image.sign * weight.value};
}

using internal::ArkitWeights;

ArkitWeights all_weights() {
  ArkitWeights weights;
  for (const internal::ArkitShape& shape : internal::arkit_shapes()) {
    auto& left = weights[std::size_t(find_arkit(shape.name).value_or(0))];
    left.assign(shape.weights.begin(), shape.weights.end());
    const std::optional<int> right = arkit_other_side(find_arkit(shape.name).value_or(0));
    if (!right) continue;
    for (const ArkitWeight& weight : left) {
      weights[std::size_t(*right)].push_back(mirrored(weight));
    }
  }
  return weights;
}

// What shapes say of the eyeballs counts more than measured angles.
Mask eyeballs_of_shapes(const ArkitChannels& channels) {
  ArkitChannels shapes = channels;
  for (std::size_t i = kArkitShapeCount; i < kArkitChannelCount; ++i) shapes.reset(i);
  const Mask reached = arkit_faps(shapes);
  Mask mask;
  for (std::size_t fap = kFirstEyeball; fap <= kLastEyeball; ++fap) mask[fap] = reached[fap];
  return mask;
}

void keep_lids_apart(Frame& frame, std::size_t upper, std::size_t lower) {
  if (!frame.mask[upper]) return;
  frame.value[upper] = std::min(frame.value[upper], kLidsMeet - frame.value[lower]);
}

}  // namespace

const ArkitWeights& internal::arkit_weights() {
  static const ArkitWeights all = all_weights();
  return all;
}

std::optional<int> arkit_other_side(int channel) {
  std::string name(kArkitNames[std::size_t(channel)]);
  for (const auto& [side, other] : {std::pair("Left", "Right"), {"Right", "Left"}}) {
    if (!name.ends_with(side)) continue;
    return find_arkit(
        name.replace(name.size() - std::string_view(side).size(), std::string::npos, other));
  }
  return std::nullopt;
}

std::optional<int> find_arkit(std::string_view name) {
  static const std::array<std::string, kArkitChannelCount> known = lower_case_names();
  if (name.size() > kLongestName) return std::nullopt;
  for (const std::size_t at : beginnings_of(name)) {
    const std::string_view rest = name.substr(at);
    const auto found = std::find(known.begin(), known.end(), plain_name(rest));
    if (found == known.end()) continue;
    const int channel = int(found - known.begin());
    // "head_yaw" is a FAP.
    if (channel < kArkitShapeCount || rest.size() == found->size()) return channel;
  }
  return std::nullopt;
}

Mask arkit_faps(const ArkitChannels& channels) {
  Mask mask;
  for (std::size_t channel = 0; channel < kArkitChannelCount; ++channel) {
    if (!channels[channel]) continue;
    for (const ArkitWeight& weight : internal::arkit_weights()[channel])
      mask.set(std::size_t(weight.fap));
  }
  return mask;
}

Frame arkit_to_fap(const ArkitFrame& frame, const ArkitChannels& channels) {
  const Mask eyeballs = eyeballs_of_shapes(channels);
  std::array<double, kFapCount + 1> sum{};
  for (std::size_t channel = 0; channel < kArkitChannelCount; ++channel) {
    if (!channels[channel] || !std::isfinite(frame[channel])) continue;
    const bool angle = channel >= kArkitShapeCount;
    for (const ArkitWeight& weight : internal::arkit_weights()[channel]) {
      const std::size_t fap = std::size_t(weight.fap);
      if (angle && eyeballs[fap]) continue;
      sum[fap] += frame[channel] * weight.value;
    }
  }
  Frame out;
  out.mask = arkit_faps(channels);
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (out.mask[std::size_t(fap)])
      out.value[std::size_t(fap)] = internal::coded_value(sum[std::size_t(fap)], fap);
  }
  keep_lids_apart(out, 19, 21);
  keep_lids_apart(out, 20, 22);
  return out;
}

}  // namespace animeme::fap
