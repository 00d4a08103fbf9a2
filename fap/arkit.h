/// @file
/// ARKit blend shapes, as phones capture faces, to FAPs and back.
///
///     animeme::fap::ArkitFrame weights{};               // all shapes at rest
///     weights[*animeme::fap::find_arkit("jawOpen")] = 0.4;
///     animeme::fap::Frame frame = animeme::fap::arkit_to_fap(weights, animeme::fap::kAllArkit);
///
/// A weight moves a whole shape, a FAP one point of the face: jawOpen alone moves the chin, the
/// lower lip, its corners and more. The map is linear: the sum over the shapes of the weight times
/// the FAPs of the full shape. The FAPs of each shape were measured on the head model ICT-FaceKit
/// (University of Southern California, MIT licence), which has ARKit's shapes: the displacement of
/// each feature point along the axis of its FAP, in units of that face (fap/semantics.md, section
/// 10). arkit_table.cpp has the numbers and lists those of other origin.
///
/// The inverse is a fit, since 66 FAPs show faces that 52 shapes do not, and several sets of shapes
/// give the same face:
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
inline constexpr int kArkitChannelCount = 61;  ///< with nine angles of head and eyes, in radians

/// ARKit's spelling ("eyeBlinkLeft", "jawOpen"; left is the person's left), in the column order of
/// Live Link Face: 52 shapes, then headYaw, headPitch, headRoll, leftEyeYaw, leftEyePitch,
/// leftEyeRoll and the same of the right eye.
extern const std::array<std::string_view, kArkitChannelCount> kArkitNames;

/// Channel (0..60) of a name; nullopt if unknown. Case is ignored, in names of shapes also "_", "-"
/// and blanks ("EyeBlinkLeft", "jaw_open"), the suffixes _L and Left, _R and Right are equivalent
/// ("eyeBlink_L"), and so is what programs put before ".", ":", "|", "/" or "__"
/// ("blendShapes.JawOpen", "head_lod0_mesh__jawOpen").
std::optional<int> find_arkit(std::string_view name);

/// The channel of the same shape of the other side of the face (eyeBlinkLeft and eyeBlinkRight);
/// nullopt: it has no sides, or is an angle. `channel` is 0..60.
std::optional<int> arkit_other_side(int channel);

/// One instant, by channel: weights of shapes, 1 is the full shape (trackers exceed it slightly,
/// which is accepted as it is), and angles in radians. Positive angles as in Live Link Face: yaw to
/// the person's right, pitch down, roll towards the person's left shoulder.
using ArkitFrame = std::array<double, kArkitChannelCount>;

/// The channels that a source provides.
using ArkitChannels = std::bitset<kArkitChannelCount>;
/// All channels.
inline constexpr ArkitChannels kAllArkit{(1ULL << kArkitChannelCount) - 1};

/// The FAPs that the channels can move: the mask of their frames. Viseme, expression, eyeball
/// depth, pupils, most of the tongue and the ears are out of reach.
Mask arkit_faps(const ArkitChannels& channels);

/// The FAPs of one instant, with arkit_faps(channels) as mask and number 0. Channels outside
/// `channels` and values that are not finite count as 0. Values are rounded to the nearest unit.
///
/// - Eyelids (FAP 19 to 22): eyeBlink at 1 makes the lids meet, that is 1024 units for both
///   together (IRISD is the opening). Where further shapes would push them past each other, the
///   upper lid stops at the lower one. This is the only nonlinear part.
/// - Eyeballs (FAP 23 to 26) turn by eyeLookIn, Out and Down (35 degrees at 1) and Up (23 degrees).
///   The eye angles are used only for an eye and axis for which `channels` has no such shape: in
///   recordings with both, the angles of the two eyes diverge by 3.7 degrees where the shapes
///   converge by as much, so they are not gaze angles. Eye roll has no FAP.
/// - Head (FAP 48 to 50): pitch is that of Live Link Face; yaw and roll change sign, since FAPs
///   turn to the left and tilt to the right.
/// - tongueOut is FAP 45, 1024 at 1: one mouth width.
/// - FAP 3 and 14 can be negative (pressed lips raise the chin, an open jaw swings back), and FAP
///   18 follows the jaw: every FAP is the displacement of its feature point.
/// - Values that an FBA stream cannot carry at fap_quant 1 are clipped to +-1860 quantiser steps.
Frame arkit_to_fap(const ArkitFrame& frame, const ArkitChannels& channels);

/// Weights of the terms of ArkitFitter's objective.
struct ArkitFitOptions {
  /// Penalty on the use of a shape, relative to its effect on the face; 0..1. It keeps shapes from
  /// cancelling each other.
  double ridge = 0.001;
  /// Penalty on the change of a weight between frames, likewise; 0..1. It keeps similar shapes from
  /// alternating. 0: frames are independent.
  double steadiness = 0.01;
  /// Preference for few shapes, relative to the default. 0: all shapes that improve the fit,
  /// including pairs that cancel each other (mouthLeft and mouthRight) and those that do not occur
  /// in speech (mouthFrown, cheekPuff). 1: a shape has to improve the fit by 0.2 mm, one of the
  /// latter by 1.6 mm, unless ARKit's shapes can make the face (within 3 %), which is then
  /// reproduced exactly.
  double sparsity = 1;
};

/// FAPs to ARKit weights, frame by frame. Movable, not copyable. Less than 1 ms per frame.
///
/// - Gaze: eyeLookIn, Out, Up and Down from the angles of FAP 23 to 26, and the eye angles the same
///   way. Head angles from FAP 48 to 50. tongueOut from FAP 45. These are exact (shapes end at 1)
///   and the inverse of arkit_to_fap().
/// - Faces that ARKit's shapes made, as those of captures are, come back as they were, whatever the
///   frame before: the most likely weights for FAPs that were rounded or quantised.
/// - Other faces: lids and brows by their FAPs alone; the rest, weights from 0 to 1 by least
/// squares
///   over the FAPs of the frame's mask, in lengths on the face (FAPU of the head that the table was
///   measured on). Lips that would stay further apart than they should are drawn together, so that
///   P, B and M close.
/// - eyeBlink and eyeWide are never on together. Where lids meet (FAP 19 and 21 add up to 1024),
///   eyeBlink is 1, or at least 0.85 if the eye looks down: lids stop at each other, so FAPs do not
///   say how far the blink would go on.
/// - FAPs that no shape reaches (pupils, ears, ...) are lost; brows raised beyond the shapes stop
///   at 1. The same frames give the same weights on every machine.
class ArkitFitter {
 public:
  explicit ArkitFitter(const ArkitFitOptions& options = {});  ///< options are not checked
  ArkitFitter(ArkitFitter&&) noexcept;                        ///< movable
  ArkitFitter& operator=(ArkitFitter&&) noexcept;
  ~ArkitFitter();

  /// `frame` should be complete (fill.h): missing FAPs do not take part in the fit. FAP 1 and 2 are
  /// ignored.
  ArkitFrame fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap
