// Unified Expressions of VRCFaceTracking as parameters of a VRChat avatar:
//
//   /avatar/parameters/v2/JawOpen  f weight     (the table in unified.cpp, as sums of ARKit's
//   shapes) /tracking/eye/LeftRightPitchYaw  4 x f degrees: left eye down, to the right, right eye
//   likewise /tracking/eye/EyesClosedAmount   f 0..1
//   /avatar/parameters/v2/JawOpen1, JawOpen2, JawOpen4 ...  T or F: bits of the weight, for avatars
//   that have no room for floats; v2/JawXNegative: T below 0
//
// VRChat passes over parameters that the avatar does not have. Which shapes of ARKit a parameter
// shows is as VRCFaceTracking's own module for Live Link has it.
// Source: VRCFaceTracking (VRCFaceTracking.Core/Params/Expressions/UnifiedExpressions.cs,
// UnifiedExpressionsParameters.cs, UnifiedSimpleExpressions.cs, OSC/DataTypes/BinaryParameter.cs;
// LiveLinkTrackingModule, ArKitPacketReader.cs), docs.vrchat.com ("OSC Eye Tracking").
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/arkit.h"
#include "tools/live/engines/detail/osc.h"

namespace animeme::engines {

/// constant + sum of weight * channel.
struct UnifiedParameter {
  struct Term {
    std::size_t channel;
    double weight;
  };
  std::string name;  ///< without prefix
  double constant = 0;
  std::vector<Term> terms;

  double value(const fap::ArkitFrame& frame) const;
  /// Whether a face can make it less than 0.
  bool has_sign() const;
};

/// All that are sent, in their order.
std::span<const UnifiedParameter> unified_parameters();

/// Says what has changed, and everything once a second.
class UnifiedWriter {
 public:
  /// `prefix` as in "v2" or "FT/v2". `gaze`: /tracking/eye goes along. `bits`: of each parameter
  /// that is no angle, 0..8, beside the float.
  explicit UnifiedWriter(const std::string& prefix, bool gaze = true, int bits = 0);
  std::vector<OscMessage> write(const fap::ArkitFrame& frame, double seconds);

 private:
  void write_bits(const UnifiedParameter& parameter, double value,
                  std::vector<OscMessage>& out) const;

  std::string begin_;
  bool gaze_;
  int bits_;
  std::vector<OscMessage> last_;
  std::optional<double> whole_;  // seconds of the last frame with everything
};

/// Puts parameters together to a face. A channel is the mean of the parameters that say most
/// clearly what it is: those with the fewest other channels in them.
class UnifiedState {
 public:
  bool take(const OscMessage& message);  ///< false: it is nothing of a face
  fap::ArkitFrame values() const;
  fap::ArkitChannels channels() const;

 private:
  std::map<std::size_t, double> heard_;  // by place in unified_parameters()
  fap::ArkitFrame eyes_{};               // by /tracking/eye
  bool eyes_heard_ = false;
};

}  // namespace animeme::engines
