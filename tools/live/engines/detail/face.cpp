#include "tools/live/engines/detail/face.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fap/viseme.h"

namespace animeme::engines {

const std::array<std::string_view, kPresetCount> kVrm0Names{
    "A", "I", "U", "E", "O", "Blink_L", "Blink_R", "Joy", "Angry", "Sorrow", "Fun", "Surprised"};
const std::array<std::string_view, kPresetCount> kVrm1Names{
    "aa",         "ih",    "ou",    "ee",  "oh",      "blinkLeft",
    "blinkRight", "happy", "angry", "sad", "relaxed", "surprised"};

namespace {

constexpr double kRidge = 0.03;  // vowels are more alike than shapes of a face
constexpr std::size_t kBlinkLeft = 0, kBlinkRight = 7;
constexpr double kFullIntensity = 63;

struct Share {
  Preset preset;
  std::string_view shape;
  double weight;
};
constexpr Share kShares[] = {
    {Preset::a, "jawOpen", 0.5},
    {Preset::a, "mouthLowerDownLeft", 0.2},
    {Preset::a, "mouthLowerDownRight", 0.2},
    {Preset::i, "jawOpen", 0.1},
    {Preset::i, "mouthStretchLeft", 0.5},
    {Preset::i, "mouthStretchRight", 0.5},
    {Preset::u, "jawOpen", 0.1},
    {Preset::u, "mouthPucker", 0.8},
    {Preset::e, "jawOpen", 0.25},
    {Preset::e, "mouthSmileLeft", 0.3},
    {Preset::e, "mouthSmileRight", 0.3},
    {Preset::o, "jawOpen", 0.3},
    {Preset::o, "mouthFunnel", 0.6},
    {Preset::blink_left, "eyeBlinkLeft", 1},
    {Preset::blink_right, "eyeBlinkRight", 1},
    {Preset::joy, "mouthSmileLeft", 0.8},
    {Preset::joy, "mouthSmileRight", 0.8},
    {Preset::joy, "cheekSquintLeft", 0.5},
    {Preset::joy, "cheekSquintRight", 0.5},
    {Preset::angry, "browDownLeft", 0.9},
    {Preset::angry, "browDownRight", 0.9},
    {Preset::angry, "noseSneerLeft", 0.3},
    {Preset::angry, "noseSneerRight", 0.3},
    {Preset::sorrow, "browInnerUp", 0.8},
    {Preset::sorrow, "mouthFrownLeft", 0.6},
    {Preset::sorrow, "mouthFrownRight", 0.6},
    {Preset::fun, "mouthSmileLeft", 0.5},
    {Preset::fun, "mouthSmileRight", 0.5},
    {Preset::surprised, "browInnerUp", 0.8},
    {Preset::surprised, "browOuterUpLeft", 0.8},
    {Preset::surprised, "browOuterUpRight", 0.8},
    {Preset::surprised, "eyeWideLeft", 0.8},
    {Preset::surprised, "eyeWideRight", 0.8},
    {Preset::surprised, "jawOpen", 0.2},
};

// Those of A I U E O.
std::vector<fap::Frame> vowel_shapes() {
  std::vector<fap::Frame> shapes;
  for (const int viseme : {10, 12, 14, 11, 13}) shapes.push_back(fap::viseme_shape(viseme));
  return shapes;
}

}  // namespace

Face between(const Face& from, const Face& to, double share) {
  Face out;
  const auto mix = [share](double a, double b) { return a + (b - a) * share; };
  std::transform(from.arkit.begin(), from.arkit.end(), to.arkit.begin(), out.arkit.begin(), mix);
  std::transform(from.presets.begin(), from.presets.end(), to.presets.begin(), out.presets.begin(),
                 mix);
  return out;
}

PresetFitter::PresetFitter() : vowels_(vowel_shapes(), {}, kRidge) {}

Presets PresetFitter::fit(const fap::Frame& low, const fap::Frame& high,
                          const fap::ArkitFrame& arkit) {
  Presets out{};
  const auto at = [&out](Preset preset) -> double& { return out[std::size_t(preset)]; };
  const std::vector<double>& vowels = vowels_.fit(low);
  // Together no more than one whole mouth.
  const double most = std::max(1.0, std::accumulate(vowels.begin(), vowels.end(), 0.0));
  std::transform(vowels.begin(), vowels.end(), out.begin(), [most](double w) { return w / most; });
  at(Preset::blink_left) = arkit[kBlinkLeft];
  at(Preset::blink_right) = arkit[kBlinkRight];
  if (!high.mask[2]) return out;
  const auto mood = [&](int expression, int intensity) {
    const double weight = std::clamp(double(intensity) / kFullIntensity, 0.0, 1.0);
    if (expression == 1) at(Preset::joy) += weight;
    if (expression == 2) at(Preset::sorrow) += weight;
    if (expression == 3) at(Preset::angry) += weight;
    if (expression == 6) at(Preset::surprised) += weight;
  };
  mood(high.expression.select1, high.expression.intensity1);
  mood(high.expression.select2, high.expression.intensity2);
  for (double& weight : out) weight = std::clamp(weight, 0.0, 1.0);
  return out;
}

fap::ArkitFrame arkit_of_presets(const Presets& presets) {
  fap::ArkitFrame out{};
  for (const Share& share : kShares) {
    double& weight = out[std::size_t(fap::find_arkit(share.shape).value_or(0))];
    weight = std::clamp(weight + share.weight * presets[std::size_t(share.preset)], 0.0, 1.0);
  }
  return out;
}

Quaternion quaternion_of(const Turn& turn) {
  const double sy = std::sin(turn.yaw / 2), cy = std::cos(turn.yaw / 2);
  const double sx = std::sin(turn.pitch / 2), cx = std::cos(turn.pitch / 2);
  const double sz = std::sin(turn.roll / 2), cz = std::cos(turn.roll / 2);
  return {cy * sx * cz + sy * cx * sz, sy * cx * cz - cy * sx * sz, cy * cx * sz - sy * sx * cz,
          cy * cx * cz + sy * sx * sz};
}

Turn turn_of(const Quaternion& q) {
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(square > 1e-12) || !std::isfinite(square)) return {};
  const double s = 2 / square;
  const double sine = s * (q.w * q.x - q.y * q.z);
  return {std::atan2(s * (q.x * q.z + q.w * q.y), 1 - s * (q.x * q.x + q.y * q.y)),
          std::asin(std::clamp(sine, -1.0, 1.0)),
          std::atan2(s * (q.x * q.y + q.w * q.z), 1 - s * (q.x * q.x + q.z * q.z))};
}

}  // namespace animeme::engines
