#include "tools/view/gltf/detail/clip_keys.h"

#include <algorithm>
#include <cmath>

namespace animeme::gltf {

ClipKeys keys_of_clip(const head::Rig& rig, const fap::Sequence& clip,
                      std::span<const fap::VisemeWeights> visemes,
                      const std::function<void(double)>& progress) {
  ClipKeys keys;
  head::Pose pose;
  for (const fap::Frame& frame : clip.frames) {
    head::PoseOptions options;
    if (keys.times.size() < visemes.size()) options.visemes = visemes[keys.times.size()];
    keys.times.push_back(float(clip.rate.seconds(double(frame.number - clip.frames[0].number))));
    const head::ControlValues values = head::control_values(rig, frame, options);
    keys.weights.emplace_back();
    for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
      keys.weights.back().push_back(values[head::kFirstShape + i] / head::kFullShape);
    }
    head::pose(rig, values, pose, options);
    keys.bones.push_back(bones_of(rig, pose));
    progress(double(keys.times.size()) / double(clip.frames.size()));
  }
  return keys;
}

std::vector<float> rotation_keys(const NodeTurn& node, const ClipKeys& keys, Bone bone,
                                 double share) {
  std::vector<float> out;
  Quaternion last = node.rotation({0, 0, 0, 1});
  for (const auto& frame : keys.bones) {
    const auto& turn = frame[std::size_t(bone)].rotation;
    Quaternion q = node.rotation(share_of({turn[0], turn[1], turn[2], turn[3]}, share));
    double along = 0;
    for (std::size_t i = 0; i < 4; ++i) along += q[i] * last[i];
    for (double& part : q) part *= along < 0 ? -1 : 1;
    last = q;
    for (const double part : q) out.push_back(float(part));
  }
  return out;
}

bool turns(const ClipKeys& keys, Bone bone) {
  return std::any_of(keys.bones.begin(), keys.bones.end(), [&](const auto& frame) {
    return std::abs(frame[std::size_t(bone)].rotation[3]) < 1 - 1e-9;
  });
}

}  // namespace animeme::gltf
