// The packet of Live Link Face (ARKit mode), version 6, all numbers big endian:
//
//   u8 6; i32 n, n characters: device; i32 n, n characters: subject; i32 frame, f32 part of a
//   frame, i32 and i32 frames a second (numerator, denominator); u8 61; 61 x f32: shapes, angles in
//   radians
//
// The shapes are in the order of Unreal's EARFaceBlendShape, which has JawLeft before JawRight and
// MouthLeft before MouthRight where the app's CSV has them the other way round. A phone that sees
// no face leaves out what comes behind the subject. Source: PyLiveLinkFace
// (pylivelinkface/pylivelinkface.py), LiveLinkTrackingModule of VRCFaceTracking
// (ArKitPacketReader.cs, which takes packets of 312 bytes alone: device 36, subject 6), Unreal's
// manual (EARFaceBlendShape).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/arkit.h"

namespace animeme::engines {

struct LiveLinkPacket {
  std::string device;   ///< tells two phones of one name apart
  std::string subject;  ///< name in Unreal's list
  bool face = true;     ///< false: nobody is seen, and the rest means nothing
  std::int32_t frame = 0;
  float part = 0;  ///< of a frame, 0..1
  std::int32_t rate = 60, denominator = 1;
  fap::ArkitFrame values{};  ///< in the order of fap::kArkitNames

  /// Of `frame`; nothing if the rate is none.
  std::optional<double> seconds() const;
};

std::vector<std::uint8_t> write_live_link(const LiveLinkPacket& packet);

/// Nothing: it is no such packet, or a value is not finite.
std::optional<LiveLinkPacket> read_live_link(std::span<const std::uint8_t> bytes);

/// 36 characters in the form of a UUID, the same for the same name.
std::string device_of(const std::string& subject);

}  // namespace animeme::engines
