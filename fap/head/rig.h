/// @file
/// From FAPs to a moving face.
///
///     animeme::head::Rig rig = animeme::head::make_rig(head);
///     animeme::head::Pose pose;
///     for (const fap::Frame& frame : clip.frames) {
///       animeme::head::pose(rig, frame, pose);
///       draw(pose);
///     }
///
/// Each FAP moves its feature point by value * FAPU/1024 along its axis, and what lies around along
/// with it. That part is linear: one list of small moves for each FAP (Target), which is also what
/// a morph target of glTF is. On top of it come lids that slide over the eyeball, lips and lids
/// that touch and do not pass through each other, eyeballs, the jaw and the turn of the head.
///
/// Your own head: own_head.h makes a Head of your meshes. By hand: your mesh as Part::skin, the
/// feature points that you know (leave the others at kMissing), its FAPU and eyes. All other parts
/// and the seams may stay empty. A head with targets of its own (Head::targets) moves by them
/// alone. Where they are those of shapes (Head::shapes), each frame is fitted: see
/// control_values().
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fap/frame.h"
#include "fap/head/model.h"
#include "fap/shape_fit.h"

namespace animeme::head {

/// How far points may come together before the skin between them folds over: about half of
/// their distance at rest, in units of the FAP that moves them. No limit where a point is missing.
struct Rooms {
  float brows = 0;      ///< 4.1 and 4.2 to each other: FAP 37 and 38 together; half of it apart
  float brow_lid = 0;   ///< 4.3 to 3.13, brows to upper lids: FAP 31..36 down
  float upper_lip = 0;  ///< 8.1 to 2.2: FAP 51, 55 and 56 beyond 4, 8 and 9
  float lower_lip = 0;  ///< 8.2 to 2.3: FAP 52, 57 and 58 beyond 5, 10 and 11
  float nose_lip = 0;   ///< 8.1 to 9.15: the FAPs of the upper lip up
  float corner = 0;     ///< 2.4 to 8.3: FAP 53 less than 6, 54 beside 7
  float lip_chin = 0;   ///< 8.2 to 2.10: the FAPs of the lower lip down
  float chin = 0;       ///< 2.10 to 2.1: FAP 18 down
};

/// How far a FAP can move a face, in its units: from 85 % of that on it moves it less and less.
struct Reach {
  int fap = 0;     ///< 3..68
  float low = 0;   ///< negative
  float high = 0;  ///< positive
};

/// A triangle of the skin that is seen from outside.
struct OuterTriangle {
  Triangle corners;    ///< vertices of the skin
  Vec3 normal;         ///< at rest; twice its area long
  bool rolls = false;  ///< turns over beside the corners when a mouth is as wide open as jaws go
};

/// A row of teeth seen from above as half an ellipse, a little squarer (exponent 2.5): open to the
/// back.
struct DentalArch {
  Vec3 middle;                          ///< between its ends, at half of its height
  float half_width = 0;                 ///< along X
  float depth = 0;                      ///< along Z, from the ends to the front
  float half_height = 0;                ///< along Y, with the gums
  std::vector<std::uint32_t> vertices;  ///< of the skin before it, which must not get into it
};

/// FAP 3 at which the teeth meet: a chin that rises further leaves them where they are.
inline constexpr float kBite = -100;

/// A head that is ready to move.
struct Rig {
  /// A part at rest.
  struct Shape {
    std::vector<Vec3> positions;      ///< cm
    std::vector<Vec3> normals;        ///< length 1
    std::vector<Triangle> triangles;  ///< as in the mesh, then its veils
  };
  std::array<Shape, kPartCount> parts;  ///< neutral
  std::vector<Target> targets;          ///< by control, then by part
  /// Of heads that have them. Without ARKit's jaw the FAPs of jaw and lips are measured at the
  /// feature points, where the head has 2.2 to 2.5.
  std::vector<ShapeControl> shapes;
  fap::LipMeasures lip_measures;              ///< of the shapes
  double mouth_gain = 1;                      ///< see Head
  std::array<bool, kPartCount> deforms = {};  ///< which parts have a target, or lashes that turn
  /// Parts whose shapes were modelled with the jaw's motion, or the gaze of eyes: they turn with
  /// the head alone, their shapes show the rest.
  std::array<bool, kPartCount> shown_by_shapes = {};
  fap::Fapu fapu;                                ///< units of the neutral face, cm
  std::array<Eye, 2> eyes;                       ///< left, right
  Vec3 jaw_axis;                                 ///< see Head
  Vec3 neck_pivot;                               ///< see Head
  Vec3 chin;                                     ///< 2.1, neutral
  std::vector<ContactPair> lips;                 ///< see Seams
  std::array<std::vector<ContactPair>, 2> lids;  ///< upper with lower rim, left and right eye
  std::array<std::vector<std::uint32_t>, 2> lid_vertices;  ///< that slide, left and right eye
  std::array<std::vector<std::uint32_t>, 2> eye_skin;      ///< before the left and right eye
  std::vector<std::uint32_t> lash_anchors;                 ///< see Head
  Rooms rooms;                                             ///< how far points may go
  std::vector<Reach> reaches;  ///< of FAPs, where the targets are make_rig()'s own
  /// What must not turn over, on heads that have reaches and known lips.
  std::vector<OuterTriangle> outside;
  /// By number of a FAP, positive: no less of it is shown for triangles that roll.
  std::array<float, fap::kFapCount + 1> usual = {};
  std::array<DentalArch, 2> teeth;       ///< upper, lower
  std::array<float, 2> lid_follow = {};  ///< FAP 19 for one unit of FAP 25, and 20 for 26
  std::vector<float> neck_weights;       ///< of the skin: 1 turns with the head, 0 stays
};

/// Prepares a head. Deterministic; about half a second for 25 000 vertices.
/// Weights: normalised Franke-Little weights of the distance along the mesh around each feature
/// point, smoothed, then made exact at all feature points by a small linear system; so lips are
/// separated by the slit between them. Feature points that the head does not have move nothing.
Rig make_rig(const Head& head);

/// What a pose does beyond the tables of the standard.
struct PoseOptions {
  /// Lips and lids stop where they touch, and are shut where they nearly do (0.06 MNS; lids only if
  /// their Seams are known), other points stop where Rooms says, upper lids at 0.26 IRISD
  /// up, a jaw that goes back at 0.25 MNS; legal values beyond what people do are eased to that
  /// (Rig::reaches); where skin would turn over all the same, as large a share of all FAPs
  /// that bend skin is shown as leaves it whole. Without it every
  /// feature point is where its FAPs say.
  bool contact = true;
  /// Upper lids go along with eyes that look down or up: see lids_follow_gaze().
  bool follow = true;
};

/// Values by control: FAPs 3..68, then the shapes of a rig.
using ControlValues = std::vector<float>;

/// The values of a frame: low_level() of shapes.h, opened wider by Rig::mouth_gain, absent FAPs 0;
/// for a rig with shapes also their weights, times kFullShape, whose FAPs come nearest to the frame
/// (fap::ShapeFitter), few of ARKit's and none against each other; FAP 14, 18, 39 and 40 at 0 have
/// no say there, as the jaw takes the chin along and rounded lips the cheeks. FAP 1 without FAPs of
/// the mouth beside it is shown by the shapes that are visemes by name, as their maker made them
/// (mouth_gain does not count), if there is one for each viseme that it shows. Each frame stands
/// for itself, so any frame may be asked for in any order. With PoseOptions::follow after
/// lids_follow_gaze().
ControlValues control_values(const Rig& rig, const fap::Frame& frame,
                             const PoseOptions& options = {});

/// As real lids do, ours go along with the eyeballs: where a frame of low-level FAPs does not carry
/// FAP 19 or 20, it gets the one that moves the rim by 0.65 of the pitch of its eye (FAP 25, 26).
/// The standard says nothing of it. What a frame carries stays, 0 as well; eyes that lack and rigs
/// with shapes have no such lids.
void lids_follow_gaze(const Rig& rig, fap::Frame& frame);

/// A head at one instant.
struct Pose {
  /// Vertices of the parts that deform. Empty: as in Rig::parts.
  std::array<std::vector<Vec3>, kPartCount> positions;
  std::array<std::vector<Vec3>, kPartCount> normals;  ///< as many as positions, length 1
  /// To be applied to positions and normals of each part. Identity for skin and body.
  std::array<Transform, kPartCount> transforms;
  Transform head;  ///< the turn of the head about the neck
  Transform jaw;   ///< the turn and shift of the jaw in the head
};

/// Moves the head. FAP 1 and 2 are shown as low_level() of shapes.h says; an absent FAP is 0.
/// `out` keeps its memory from call to call. Values of any size are taken; those beyond the ranges
/// of the standard look as they may.
void pose(const Rig& rig, const fap::Frame& frame, Pose& out, const PoseOptions& options = {});

/// The same by what control_values() gave, or by values between two frames; as many as that gives.
void pose(const Rig& rig, const ControlValues& values, Pose& out, const PoseOptions& options = {});

/// One pose.
Pose pose(const Rig& rig, const fap::Frame& frame, const PoseOptions& options = {});

}  // namespace animeme::head
