/// @file
/// The rig: moves a head by FAPs.
///
///     animeme::head::Rig rig = animeme::head::make_rig(head);
///     animeme::head::Pose pose;
///     for (const fap::Frame& frame : clip.frames) {
///       animeme::head::pose(rig, frame, pose);
///       draw(pose);
///     }
///
/// Each FAP moves its feature point by value * FAPU/1024 along its axis, and the surrounding skin
/// with it. That part is linear: a list of small displacements per FAP (Target), the same as a
/// morph target of glTF. In addition, lids slide over the eyeball, lips and lids collide instead of
/// passing through each other, and eyeballs, jaw and head rotate.
///
/// For your own head use own_head.h. By hand: your mesh as Part::skin, the feature points that you
/// know (leave the others at kMissing), FAPU and eyes. All other parts and the seams may stay
/// empty. A head with targets of its own (Head::targets) moves by them alone. If these belong to
/// shapes (Head::shapes), weights are fitted for each frame: see control_values().
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fap/frame.h"
#include "fap/head/model.h"
#include "fap/shape_fit.h"
#include "fap/viseme.h"

namespace animeme::head {

/// How far points may approach each other before the skin between them folds over: about half of
/// their distance at rest, in units of the FAP that moves them. No limit if a point is missing.
struct Rooms {
  float brows = 0;      ///< 4.1 to 4.2: FAP 37 and 38 together; half of it apart
  float brow_lid = 0;   ///< 4.3 to 3.13, brows to upper lids: FAP 31..36 down
  float upper_lip = 0;  ///< 8.1 to 2.2: FAP 51, 55 and 56 beyond 4, 8 and 9
  float lower_lip = 0;  ///< 8.2 to 2.3: FAP 52, 57 and 58 beyond 5, 10 and 11
  float nose_lip = 0;   ///< 8.1 to 9.15: the FAPs of the upper lip up
  float corner = 0;     ///< 2.4 to 8.3: FAP 53 less than 6; likewise 54 and 7
  float lip_chin = 0;   ///< 8.2 to 2.10: the FAPs of the lower lip down
  float chin = 0;       ///< 2.10 to 2.1: FAP 18 down
};

/// Range of a FAP, in its units: beyond 85 % of it motion is compressed.
struct Reach {
  int fap = 0;     ///< 3..68
  float low = 0;   ///< negative
  float high = 0;  ///< positive
};

/// A skin triangle that is visible from outside.
struct OuterTriangle {
  Triangle corners;    ///< vertices of the skin
  Vec3 normal;         ///< at rest; twice its area long
  bool rolls = false;  ///< turns over beside the mouth corners when the mouth is opened fully
};

/// A row of teeth seen from above as half an ellipse, slightly squared (exponent 2.5), open to the
/// back.
struct DentalArch {
  Vec3 middle;                          ///< between its ends, at half of its height
  float half_width = 0;                 ///< along X
  float depth = 0;                      ///< along Z, from the ends to the front
  float half_height = 0;                ///< along Y, with the gums
  std::vector<std::uint32_t> vertices;  ///< of the skin in front of it, which must not enter it
};

/// FAP 3 at which the teeth meet: if the chin rises further, the lower teeth stay.
inline constexpr float kBite = -100;

/// A head that is ready to move.
struct Rig {
  /// A part at rest.
  struct Shape {
    std::vector<Vec3> positions;      ///< cm
    std::vector<Vec3> normals;        ///< length 1
    std::vector<Triangle> triangles;  ///< as in the mesh, then the transparent ones
  };
  std::array<Shape, kPartCount> parts;  ///< neutral
  std::vector<Target> targets;          ///< by control, then by part
  /// Shapes of heads that have them. Without ARKit's jaw, the FAPs of jaw and lips are measured at
  /// the feature points, if the head has 2.2 to 2.5.
  std::vector<ShapeControl> shapes;
  fap::LipMeasures lip_measures;              ///< of the shapes
  double mouth_gain = 1;                      ///< see Head
  std::array<bool, kPartCount> deforms = {};  ///< parts that have a target, or lashes that turn
  /// Parts whose shapes include the motion of the jaw or the gaze: they turn with the head only,
  /// their shapes show the rest.
  std::array<bool, kPartCount> shown_by_shapes = {};
  fap::Fapu fapu;                                ///< units of the neutral face, cm
  std::array<Eye, 2> eyes;                       ///< left, right
  Vec3 jaw_axis;                                 ///< see Head
  Vec3 neck_pivot;                               ///< see Head
  Vec3 chin;                                     ///< 2.1, neutral
  std::vector<ContactPair> lips;                 ///< see Seams
  std::array<std::vector<ContactPair>, 2> lids;  ///< upper with lower rim, left and right eye
  std::array<std::vector<std::uint32_t>, 2> lid_vertices;  ///< that slide, left and right eye
  std::array<std::vector<std::uint32_t>, 2> eye_skin;      ///< in front of the left and right eye
  std::vector<std::uint32_t> lash_anchors;                 ///< see Head
  Rooms rooms;                                             ///< limits of approaching points
  std::vector<Reach> reaches;  ///< of FAPs, if the targets are make_rig()'s own
  /// Triangles that must not turn over, on heads that have reaches and known lips.
  std::vector<OuterTriangle> outside;
  /// By FAP number, positive: at least this much is shown, even if triangles that roll turn over.
  std::array<float, fap::kFapCount + 1> usual = {};
  std::array<DentalArch, 2> teeth;       ///< upper, lower
  std::array<float, 2> lid_follow = {};  ///< FAP 19 for one unit of FAP 25, and 20 for 26
  std::vector<float> neck_weights;       ///< of the skin: 1 turns with the head, 0 stays
};

/// Prepares a head. Deterministic; about half a second for 25 000 vertices. Weights: normalised
/// Franke-Little weights of the distance along the mesh around each feature point, smoothed, then
/// made exact at all feature points by a small linear system; so the slit between the lips
/// separates them. Feature points that the head does not have move nothing.
Rig make_rig(const Head& head);

/// Features of a pose beyond the tables of the standard.
struct PoseOptions {
  /// Lips and lids stop where they touch, and are closed where they nearly do (0.06 MNS; lids only
  /// if their Seams are known); other points stop at the limits of Rooms, upper lids at 0.26 IRISD
  /// up, a jaw that moves back at 0.25 MNS; legal values beyond what people do are compressed
  /// (Rig::reaches); where skin would still turn over, all FAPs that bend it are scaled down by the
  /// same factor until it does not. If false, every feature point is exactly where its FAPs say.
  bool contact = true;
  /// Upper lids follow eyes that look down or up: see lids_follow_gaze().
  bool follow = true;
  /// What is said at this instant, if it is known (dam::VisemeCurves). A head that
  /// has_own_visemes() shows it by them, as their maker made them, in place of the FAPs of jaw,
  /// lips and tongue, which show in pauses alone (as far as the weight of silence goes); corners
  /// that are pulled further up or down than speech does (FAP 12, 13) show by ARKit's smile and
  /// frown. Of other heads the tongue moves as in viseme_shape() of shapes.h, where the frame does
  /// not move it.
  std::optional<fap::VisemeWeights> visemes = {};
};

/// True if a shape for each of the visemes 1 to 14 is among the shapes of the head.
bool has_own_visemes(const Rig& rig);

/// Values by control: FAPs 3..68, then the shapes of a rig.
using ControlValues = std::vector<float>;

/// The values of a frame: low_level() of shapes.h, with the mouth opened by Rig::mouth_gain, absent
/// FAPs 0; for a rig with shapes also their weights, times kFullShape, whose FAPs best approximate
/// the frame (fap::ShapeFitter), few of ARKit's and none against each other; FAP 14, 18, 39 and 40
/// at 0 are ignored in that fit, as the jaw moves the chin and rounded lips move the cheeks. FAP 1
/// without mouth FAPs is shown by the head's own viseme shapes, unchanged (mouth_gain does not
/// apply), if there is one for each viseme shown; so is PoseOptions::visemes. FAP 2 without FAPs of
/// the brows (31 to 38) is shown by the head's own expression, if it has that: the whole shape, or
/// where FAP 1, mouth FAPs or PoseOptions::visemes say what the mouth does, what it does above the
/// mouth, so that lips close as without it. Frames are
/// independent, so they may be requested in any order. With PoseOptions::follow, lids_follow_gaze()
/// is applied first.
ControlValues control_values(const Rig& rig, const fap::Frame& frame,
                             const PoseOptions& options = {});

/// Makes lids follow the eyeballs, as real ones do: a frame of low-level FAPs that does not carry
/// FAP 19 or 20 gets the one that moves the rim by 0.65 of the pitch of its eye (FAP 25, 26). The
/// standard does not mention this. FAPs in the frame stay, including 0; missing eyes and rigs with
/// shapes have no such lids.
void lids_follow_gaze(const Rig& rig, fap::Frame& frame);

/// A head at one instant.
struct Pose {
  /// Vertices of the parts that deform. Empty: as in Rig::parts.
  std::array<std::vector<Vec3>, kPartCount> positions;
  std::array<std::vector<Vec3>, kPartCount> normals;  ///< as many as positions, length 1
  /// To be applied to positions and normals of each part. Identity for skin and body.
  std::array<Transform, kPartCount> transforms;
  Transform head;  ///< rotation of the head about the neck
  Transform jaw;   ///< rotation and translation of the jaw in the head
};

/// Moves the head. FAP 1 and 2 are shown as in low_level() of shapes.h; an absent FAP is 0. `out`
/// keeps its memory between calls. Values of any size are accepted; those beyond the ranges of the
/// standard may look wrong.
void pose(const Rig& rig, const fap::Frame& frame, Pose& out, const PoseOptions& options = {});

/// The same from control_values(), or from values interpolated between two frames, of the same
/// size.
void pose(const Rig& rig, const ControlValues& values, Pose& out, const PoseOptions& options = {});

/// One pose.
Pose pose(const Rig& rig, const fap::Frame& frame, const PoseOptions& options = {});

}  // namespace animeme::head
