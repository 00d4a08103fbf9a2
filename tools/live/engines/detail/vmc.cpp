#include "tools/live/engines/detail/vmc.h"

#include <algorithm>

#include "fap/detail/text_scanner.h"

namespace animeme::engines {
namespace {

using fap::detail::lower_case;

constexpr double kMostWeight = 2;  // trackers go a little beyond 1

std::optional<std::size_t> preset_of(const std::string& lower) {
  for (std::size_t i = 0; i < kPresetCount; ++i) {
    if (lower == lower_case(kVrm0Names[i]) || lower == lower_case(kVrm1Names[i])) return i;
  }
  return std::nullopt;
}

OscMessage bone_message(const Bone& bone, const fap::ArkitFrame& values) {
  const Quaternion q =
      quaternion_of({values[bone.channel], values[bone.channel + 1], values[bone.channel + 2]});
  return {
      "/VMC/Ext/Bone/Pos",
      {std::string(bone.name), 0.0f, 0.0f, 0.0f, float(q.x), float(q.y), float(q.z), float(q.w)}};
}

}  // namespace

std::vector<OscMessage> vmc_messages(const Face& face, double seconds, ShapeNames names,
                                     bool bones) {
  std::vector<OscMessage> out{{"/VMC/Ext/OK", {1, 3, 0}}, {"/VMC/Ext/T", {float(seconds)}}};
  const auto add = [&out](std::string name, double weight) {
    out.push_back({"/VMC/Ext/Blend/Val", {std::move(name), float(weight)}});
  };
  if (bones) {
    for (const Bone& bone : kBones) out.push_back(bone_message(bone, face.arkit));
  }
  if (names == ShapeNames::arkit) {
    for (std::size_t i = 0; i < fap::kArkitShapeCount; ++i) {
      std::string name(fap::kArkitNames[i]);
      name[0] = char(name[0] - 'a' + 'A');
      add(std::move(name), face.arkit[i]);
    }
  } else {
    const auto& list = names == ShapeNames::vrm0 ? kVrm0Names : kVrm1Names;
    for (std::size_t i = 0; i < kPresetCount; ++i) add(std::string(list[i]), face.presets[i]);
  }
  out.push_back({"/VMC/Ext/Blend/Apply", {}});
  return out;
}

OscMessage vmc_end() { return {"/VMC/Ext/OK", {0}}; }

VmcState::Effect VmcState::take(const OscMessage& message) {
  if (message.address == "/VMC/Ext/OK") {
    const auto loaded = message.number(0);
    if (!loaded) return Effect::none;
    const bool before = std::exchange(loaded_, *loaded != 0);
    return before && !loaded_ ? Effect::end : Effect::some;
  }
  if (message.address == "/VMC/Ext/T") {
    seconds_ = message.number(0);
    return seconds_ ? Effect::some : Effect::none;
  }
  if (message.address == "/VMC/Ext/Bone/Pos") {
    const std::string name = message.text(0);
    const auto bone = std::find_if(kBones.begin(), kBones.end(),
                                   [&](const Bone& each) { return each.name == name; });
    const auto x = message.number(4), y = message.number(5), z = message.number(6),
               w = message.number(7);
    if (!x || !y || !z || !w) return Effect::none;
    if (bone == kBones.end()) return Effect::some;
    const Turn turn = turn_of({*x, *y, *z, *w});
    values_[bone->channel] = turn.yaw;
    values_[bone->channel + 1] = turn.pitch;
    values_[bone->channel + 2] = turn.roll;
    for (std::size_t i = 0; i < 3; ++i) channels_.set(bone->channel + i);
    return Effect::some;
  }
  if (message.address == "/VMC/Ext/Blend/Val") {
    constexpr std::string_view kPart = "BlendShape.";  // of files of VRM; some hand it on
    std::string name = message.text(0);
    if (name.starts_with(kPart)) name.erase(0, kPart.size());
    const auto value = message.number(1);
    if (!value) return Effect::none;
    const double weight = std::clamp(*value, 0.0, kMostWeight);
    if (const auto channel = fap::find_arkit(name); channel && *channel < fap::kArkitShapeCount) {
      values_[std::size_t(*channel)] = weight;
      channels_.set(std::size_t(*channel));
      shape_ = true;
    } else if (const std::string lower = lower_case(name); lower == "blink") {
      presets_[std::size_t(Preset::blink_left)] = presets_[std::size_t(Preset::blink_right)] =
          weight;
      preset_ = true;
    } else if (const auto preset = preset_of(lower)) {
      presets_[*preset] = weight;
      preset_ = true;
    }
    return Effect::some;
  }
  if (message.address == "/VMC/Ext/Blend/Apply") {
    return channels_.any() || preset_ ? Effect::frame : Effect::some;
  }
  return Effect::none;
}

fap::ArkitFrame VmcState::values() const {
  if (shape_ || !preset_) return values_;
  fap::ArkitFrame out = arkit_of_presets(presets_);
  std::copy(values_.begin() + fap::kArkitShapeCount, values_.end(),
            out.begin() + fap::kArkitShapeCount);
  return out;
}

fap::ArkitChannels VmcState::channels() const {
  if (shape_ || !preset_) return channels_;
  fap::ArkitChannels out = channels_;
  for (std::size_t i = 0; i < fap::kArkitShapeCount; ++i) {
    // Presets know no gaze, which the eyes' bones then have to themselves.
    out[i] = !fap::kArkitNames[i].starts_with("eyeLook");
  }
  return out;
}

}  // namespace animeme::engines
