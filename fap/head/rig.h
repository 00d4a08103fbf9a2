// From FAPs to a moving face.
//
//     animeme::head::Rig rig = animeme::head::make_rig(head);
//     animeme::head::Pose pose;
//     for (const fap::Frame& frame : clip.frames) {
//       animeme::head::pose(rig, frame, pose);
//       draw(pose);
//     }
//
// Each FAP moves its feature point by value * FAPU/1024 along its axis, and what lies around along
// with it. That part is linear: one list of small moves for each FAP (Target), which is also what a
// morph target of glTF is. On top of it come lids that slide over the eyeball, lips and lids that
// touch and do not pass through each other, eyeballs, the jaw and the turn of the head.
//
// Your own head: own_head.h makes a Head of your meshes. By hand: your mesh as Part::skin, the
// feature points that you know (leave the others at kMissing), its FAPU and eyes. All other parts
// and the seams may stay empty. A head with targets of its own (Head::targets) moves by them alone.
// Where they are those of shapes (Head::shapes), each frame is fitted: see control_values().
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fap/frame.h"
#include "fap/head/model.h"

namespace animeme::head {

/// A head that is ready to move.
struct Rig {
  struct Shape {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< length 1
    std::vector<Triangle> triangles;
  };
  std::array<Shape, kPartCount> parts;        ///< neutral
  std::vector<Target> targets;                ///< by control, then by part
  std::vector<ShapeControl> shapes;           ///< of heads that have them
  std::array<bool, kPartCount> deforms = {};  ///< which parts have a target, or lashes that turn
  /// Parts whose shapes were modelled with the jaw's motion, or the gaze of eyes: they turn with
  /// the head alone, their shapes show the rest.
  std::array<bool, kPartCount> shown_by_shapes = {};
  fap::Fapu fapu;
  std::array<Eye, 2> eyes;
  Vec3 jaw_axis;
  Vec3 neck_pivot;
  Vec3 chin;                      ///< 2.1, neutral
  std::vector<ContactPair> lips;  ///< see Seams
  std::array<std::vector<ContactPair>, 2> lids;
  std::array<std::vector<std::uint32_t>, 2> lid_vertices;  ///< that slide, left and right eye
  std::array<std::vector<std::uint32_t>, 2> eye_skin;      ///< before the left and right eye
  std::vector<std::uint32_t> lash_anchors;                 ///< see Head
  float brow_room = 0;  ///< most of FAP 37 and 38 together: half of the distance of the brows
  float chin_room = 0;  ///< how much nearer the lower lip may come to the chin, in units of FAP 5
  std::vector<float> neck_weights;  ///< of the skin: 1 turns with the head, 0 stays
};

/// Prepares a head. Deterministic; about half a second for 25 000 vertices.
/// Weights: normalised Franke-Little weights of the distance along the mesh around each feature
/// point, smoothed, then made exact at all feature points by a small linear system; so lips are
/// separated by the slit between them. Feature points that the head does not have move nothing.
Rig make_rig(const Head& head);

/// Values by control: FAPs 3..68, then the shapes of a rig.
using ControlValues = std::vector<float>;

/// The values of a frame: low_level() of shapes.h, absent FAPs 0; for a rig with shapes also their
/// weights, times kFullShape, whose FAPs come nearest to the frame (fap::ShapeFitter); FAP 14 and
/// 18 at 0 have no say there, as the jaw takes the chin along. Each frame stands for itself, so any
/// frame may be asked for in any order.
ControlValues control_values(const Rig& rig, const fap::Frame& frame);

struct PoseOptions {
  /// Lips and lids stop where they touch, brows half way to each other, the lower lip above the
  /// chin, wide eyes at 0.4 IRISD. Without it every feature point is where its FAPs say.
  bool contact = true;
};

/// A head at one instant.
struct Pose {
  /// Vertices of the parts that deform. Empty: as in Rig::parts.
  std::array<std::vector<Vec3>, kPartCount> positions;
  std::array<std::vector<Vec3>, kPartCount> normals;
  /// To be applied to positions and normals of each part. Identity for skin and body.
  std::array<Transform, kPartCount> transforms;
  Transform head;  ///< the turn of the head about the neck
  Transform jaw;   ///< the turn and shift of the jaw in the head
};

/// Moves the head. FAP 1 and 2 are shown as low_level() of shapes.h says; an absent FAP is 0.
/// `out` keeps its memory from call to call. Values of any size are taken; those beyond the ranges
/// of the standard look as they may.
void pose(const Rig& rig, const fap::Frame& frame, Pose& out, const PoseOptions& options = {});

/// One pose.
Pose pose(const Rig& rig, const fap::Frame& frame, const PoseOptions& options = {});

}  // namespace animeme::head
