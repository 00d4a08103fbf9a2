// One instant of a face as engines take it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fap/arkit.h"
#include "fap/frame.h"
#include "fap/shape_fit.h"

namespace animeme::engines {

/// The presets of VRM, where a face without ARKit's shapes is moved by them.
enum class Preset : std::uint8_t {
  a,
  i,
  u,
  e,
  o,
  blink_left,
  blink_right,
  joy,
  angry,
  sorrow,
  fun,
  surprised
};
inline constexpr std::size_t kPresetCount = 12;
using Presets = std::array<double, kPresetCount>;

/// Their names in VRM 0.x and VRM 1.0. Source: vrm.dev; VMC protocol, table of both.
extern const std::array<std::string_view, kPresetCount> kVrm0Names, kVrm1Names;

struct Face {
  fap::ArkitFrame arkit{};
  Presets presets{};
};

/// On the straight line from one face to the other; `share` 0..1.
Face between(const Face& from, const Face& to, double share);

/// Presets of faces, frame by frame: the vowels whose shapes (fap::viseme_shape()) come nearest to
/// jaw and lips, consonants included, as these avatars have no others; lids as ARKit's; moods are
/// the expressions of FAP 2.
class PresetFitter {
 public:
  PresetFitter();
  /// `low`: what a receiver shows as low-level FAPs; `high`: with FAP 2.
  Presets fit(const fap::Frame& low, const fap::Frame& high, const fap::ArkitFrame& arkit);

 private:
  fap::ShapeFitter vowels_;
};

/// Shapes of ARKit that look about like presets: by eye.
fap::ArkitFrame arkit_of_presets(const Presets& presets);

/// A turn of head or eye, radians as in fap::ArkitFrame: yaw to the person's right, pitch down,
/// roll towards the person's left shoulder. These are Unity's turns about y, x and z of somebody
/// who looks along +z, yaw outermost, as fap/head has it.
struct Turn {
  double yaw = 0, pitch = 0, roll = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
Quaternion quaternion_of(const Turn& turn);
/// Of any length above 0; else no turn.
Turn turn_of(const Quaternion& quaternion);

/// The three bones that turn, and the channel of the first of their three angles.
struct Bone {
  std::string_view name;  ///< HumanBodyBones of Unity
  std::size_t channel;
};
inline constexpr std::array<Bone, 3> kBones{{{"Head", 52}, {"LeftEye", 55}, {"RightEye", 58}}};

}  // namespace animeme::engines
