/// @file
/// From ARKit blend shapes, as phones capture faces, to FAPs and back.
///
///     animeme::fap::ArkitFrame weights{};               // all shapes at rest
///     weights[*animeme::fap::find_arkit("jawOpen")] = 0.4;
///     animeme::fap::Frame frame = animeme::fap::arkit_to_fap(weights, animeme::fap::kAllArkit);
///
/// A weight moves a whole shape, a FAP one point of the face: jawOpen alone moves the chin, the
/// lower lip, its corners and more. The map is linear, weight times the FAPs of the full shape,
/// summed over the shapes. What the FAPs of each shape are was measured on the head model
/// ICT-FaceKit (University of Southern California, MIT licence), which has ARKit's shapes: how far
/// each feature point moves along the axis of its FAP, in units of that face (fap/semantics.md,
/// section 10). See arkit_table.cpp for the numbers and what is not from there.
///
/// The way back is a fit, since 66 FAPs show faces that 52 shapes do not and several sets of shapes
/// give one face:
///
///     animeme::fap::ArkitFitter fitter;
///     for (const Frame& frame : filled.frames) rows.push_back(fitter.fit(frame));
#pragma once

#include <array>
#include <bitset>
#include <memory>
#include <optional>
#include <string_view>

#include "fap/frame.h"

namespace animeme::fap {

inline constexpr int kArkitShapeCount = 52;    ///< blend shapes, weights from 0 to 1
inline constexpr int kArkitChannelCount = 61;  ///< and nine angles of head and eyes, in radians

/// ARKit's spelling ("eyeBlinkLeft", "jawOpen"; left is the person's left), the columns of Live
/// Link Face in their order: 52 shapes, then headYaw, headPitch, headRoll, leftEyeYaw,
/// leftEyePitch, leftEyeRoll and those of the right eye.
extern const std::array<std::string_view, kArkitChannelCount> kArkitNames;

/// Channel (0..60) of a name. Upper and lower case are the same ("EyeBlinkLeft"), and so are the
/// endings _L and Left, _R and Right ("eyeBlink_L"). Nothing if unknown.
std::optional<int> find_arkit(std::string_view name);

/// One instant, by channel: weights of shapes, 1 is the full shape (trackers go a little beyond,
/// which is taken as it is), and angles in radians. Positive angles as Live Link Face has them:
/// yaw to the person's right, pitch down, roll towards the person's left shoulder.
using ArkitFrame = std::array<double, kArkitChannelCount>;

/// Which channels a source has.
using ArkitChannels = std::bitset<kArkitChannelCount>;
/// The channels of a source that has all of them.
inline constexpr ArkitChannels kAllArkit{(1ULL << kArkitChannelCount) - 1};

/// The FAPs that the channels reach: the mask of their frames. All but viseme, expression, eyeball
/// depth, pupils, most of the tongue and the ears can be reached.
Mask arkit_faps(const ArkitChannels& channels);

/// The FAPs of one instant, with arkit_faps(channels) as mask and number 0. Channels outside
/// `channels` and values that are not finite count as 0. Values are rounded to the nearest unit.
///
/// - Eyelids (FAP 19 to 22): eyeBlink at 1 lets the lids meet, that is 1024 units for both
///   together (IRISD is the opening). Where further shapes would push them past each other, the
///   upper lid stops at the lower one. This is the only part that is not linear.
/// - Eyeballs (FAP 23 to 26) turn by eyeLookIn, Out and Down (35 degrees at 1) and Up (23 degrees).
///   The angles of the eyes are used only for an eye and axis of which `channels` has no such
///   shape: in recordings with both, the angles of the two eyes diverge by 3.7 degrees where the
///   shapes converge by as much, so they are not those of a gaze. Eye roll has no FAP.
/// - Head (FAP 48 to 50): pitch is that of Live Link Face; yaw and roll change their sign, since
///   FAPs turn to the left and tilt to the right.
/// - tongueOut is FAP 45, 1024 at 1: one mouth width.
/// - FAP 3 and 14 go below 0 (pressed lips raise the chin, an open jaw swings back), and FAP 18
///   follows the jaw: all FAPs are where their feature point is.
/// - Values that an FBA stream cannot carry at fap_quant 1 are clipped: +-1860 quantiser steps.
Frame arkit_to_fap(const ArkitFrame& frame, const ArkitChannels& channels);

/// How ArkitFitter weighs.
struct ArkitFitOptions {
  /// What it costs to use a shape, as a share of what it does to the face; 0..1. It keeps shapes
  /// from working against each other.
  double ridge = 0.001;
  /// What it costs to change a weight from one frame to the next, likewise; 0..1. It keeps shapes
  /// that look nearly alike from taking turns. 0: every frame stands for itself.
  double steadiness = 0.01;
  /// How few shapes are used: as a share of the usual. 0: all that bring the face nearer, also ones
  /// that undo each other (mouthLeft and mouthRight) and those that nobody speaks with (mouthFrown,
  /// cheekPuff). 1: a shape has to bring it nearer by 0.2 mm, one of the latter by 1.6 mm,
  /// unless the face is one that ARKit's shapes make (within 3 %), which comes back as it was.
  double thrift = 1;
};

/// FAPs to ARKit, frame by frame. Movable, not copyable. About 0.1 ms a frame.
///
/// - Gaze: eyeLookIn, Out, Up and Down from the angles of FAP 23 to 26, and the eyes' own angles
///   the same way. The head's angles from FAP 48 to 50. tongueOut from FAP 45. These are exact
///   (shapes end at 1) and the inverse of arkit_to_fap().
/// - All other shapes: the weights from 0 to 1 whose FAPs come nearest, by least squares over the
///   FAPs of the frame's mask, in lengths on the face (FAPU of the head the table was measured on).
///   Lids of a blink count more, so that closed eyes are closed; lips that would stay further apart
///   than they should are drawn together, so that P, B and M close.
/// - FAPs that no shape reaches (pupils, ears, ...) are lost; brows raised beyond the shapes stop
///   at 1. The same frames give the same weights on every machine.
class ArkitFitter {
 public:
  explicit ArkitFitter(const ArkitFitOptions& options = {});  ///< options as they are, unchecked
  ArkitFitter(ArkitFitter&&) noexcept;                        ///< movable
  ArkitFitter& operator=(ArkitFitter&&) noexcept;
  ~ArkitFitter();

  /// `frame` should be complete (fill.h): a FAP that is missing has no say. FAP 1 and 2 are not
  /// looked at.
  ArkitFrame fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap
