// Bones of a head: neck, jaw and eyes, and where they are in each frame.
#pragma once

#include <array>
#include <string_view>

#include "fap/head/rig.h"

namespace animeme::gltf {

enum class Bone : std::uint8_t { neck, jaw, left_eye, right_eye };
inline constexpr int kBoneCount = 4;
inline constexpr std::array<std::string_view, kBoneCount> kBoneNames = {
    "neck_bone", "jaw_bone", "left_eye_bone", "right_eye_bone"};

inline constexpr float kMetres = 0.01f;  ///< a centimetre, the unit of a head

/// Rotation as x, y, z, w and place, in the space of the parent: the neck's is the scene, that of
/// the others the neck. Lengths in metres.
struct BoneKey {
  std::array<float, 4> rotation = {0, 0, 0, 1};
  head::Vec3 place;
};

/// The unit quaternion of a rotation, by its rows; w not negative.
std::array<double, 4> quaternion_of(const std::array<std::array<double, 3>, 3>& rotation);

/// The point about which a bone turns, cm in the space of the head.
head::Vec3 pivot_of(const head::Rig& rig, Bone bone);

/// The bones in a pose.
std::array<BoneKey, kBoneCount> bones_of(const head::Rig& rig, const head::Pose& pose);

}  // namespace animeme::gltf
