// The VMC protocol, a frame as messages of OSC:
//
//   /VMC/Ext/OK      i 1, i 3 (calibrated), i 0      0 alone: nothing more will come
//   /VMC/Ext/T       f seconds
//   /VMC/Ext/Bone/Pos  s name, 3 x f place, 4 x f quaternion (x y z w)   Head, LeftEye, RightEye
//   /VMC/Ext/Blend/Val s name, f weight
//   /VMC/Ext/Blend/Apply
//
// Names of ARKit begin with a capital (JawOpen), as clips of "Perfect Sync" do. Places are 0: how
// far a bone lies from its parent is the avatar's, and only EVMC4U takes it from here
// (BonePositionSynchronize, to be switched off).
// Source: sh-akira/VirtualMotionCaptureProtocol (docs/marionette-spec.markdown), EVMC4U
// (EVMC4U/ExternalReceiver.cs).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/live/engines/detail/engine_address.h"
#include "tools/live/engines/detail/face.h"
#include "tools/live/engines/detail/osc.h"

namespace animeme::engines {

std::vector<OscMessage> vmc_messages(const Face& face, double seconds, ShapeNames names,
                                     bool bones);
/// The message that ends a session.
OscMessage vmc_end();

/// What one message after the other says.
class VmcState {
 public:
  /// What a message has done: nothing that matters here, something, completed a frame
  /// (Blend/Apply), or ended the presentation (OK 0 after OK 1).
  enum class Effect { none, some, frame, end };
  Effect take(const OscMessage& message);

  fap::ArkitFrame values() const;       ///< of presets, if no shape of ARKit has come
  fap::ArkitChannels channels() const;  ///< those that have come
  /// Of the frame; nothing: no time has come since the last one was completed.
  std::optional<double> seconds() const { return seconds_; }
  void next() { seconds_.reset(); }  ///< behind a frame

 private:
  fap::ArkitFrame values_{};
  fap::ArkitChannels channels_;
  Presets presets_{};
  bool preset_ = false, shape_ = false, loaded_ = false;
  std::optional<double> seconds_;
};

}  // namespace animeme::engines
