/// @file
/// The fields of a head::Rig in the order of their bytes, for writer and reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::viewer::detail {

/// Which of some things: packed as runs.
using Flags = std::vector<bool>;

/// Rig::outside as flags of the triangles of the skin, which has their order, and of its own.
struct OutsideFlags {
  Flags outside;
  Flags rolls;
};

// Each takes an archive (Packer of pack.cpp, Unpacker of unpack.cpp) and what it writes or fills.

template <class Archive, class Shape>
void pass_part(Archive& archive, Shape& part) {
  archive.places(part.positions);
  archive.triangles(part.triangles, part.positions.size());
}

template <class Archive, class Control>
void pass_target(Archive& archive, Control& target) {
  archive.whole(target.control);
  archive.choice(target.part);
  archive.indices(target.vertices);
  archive.deltas(target.deltas, target.vertices.size());
  archive.number(target.low);
  archive.number(target.high);
}

template <class Archive, class Shape>
void pass_shape(Archive& archive, Shape& shape) {
  archive.frame(shape.faps);
  archive.perhaps(shape.arkit);
  archive.perhaps(shape.viseme);
  archive.perhaps(shape.expression);
  archive.flag(shape.upper);
}

template <class Archive, class Pairs>
void pass_pairs(Archive& archive, Pairs& pairs) {
  archive.list(pairs, [&](auto& pair) {
    archive.whole(pair.upper);
    archive.whole(pair.lower);
  });
}

template <class Archive, class Rooms>
void pass_rooms(Archive& archive, Rooms& rooms) {
  for (auto* room : {&rooms.brows, &rooms.brow_lid, &rooms.upper_lip, &rooms.lower_lip,
                     &rooms.nose_lip, &rooms.corner, &rooms.lip_chin, &rooms.chin}) {
    archive.number(*room);
  }
}

template <class Archive, class Arch>
void pass_teeth(Archive& archive, Arch& arch) {
  archive.vector(arch.middle);
  for (auto* size : {&arch.half_width, &arch.depth, &arch.half_height}) archive.number(*size);
  archive.indices(arch.vertices);
}

template <class Archive, class Measures>
void pass_lips(Archive& archive, Measures& lips) {
  for (auto& distance : lips.at_rest) archive.number(distance);
  archive.list(lips.closing, [&](auto& distances) {
    for (auto& distance : distances) archive.number(distance);
  });
}

template <class Archive, class Fapu>
void pass_fapu(Archive& archive, Fapu& fapu) {
  for (auto* unit : {&fapu.irisd, &fapu.es, &fapu.ens, &fapu.mns, &fapu.mw}) archive.number(*unit);
}

/// All that pose() and control_values() look at, but for what follows from it: normals.
template <class Archive, class AnyRig, class Outside>
void pass_rig(Archive& archive, AnyRig& rig, Outside& outside) {
  for (auto& part : rig.parts) pass_part(archive, part);
  archive.list(rig.targets, [&](auto& target) { pass_target(archive, target); });
  archive.list(rig.shapes, [&](auto& shape) { pass_shape(archive, shape); });
  pass_lips(archive, rig.lip_measures);
  archive.number(rig.mouth_gain);
  for (auto* flags : {&rig.deforms, &rig.shown_by_shapes}) {
    for (auto& flag : *flags) archive.flag(flag);
  }
  pass_fapu(archive, rig.fapu);
  for (auto& eye : rig.eyes) {
    archive.vector(eye.centre);
    archive.number(eye.radius);
  }
  for (auto* point : {&rig.jaw_axis, &rig.neck_pivot, &rig.chin}) archive.vector(*point);
  pass_pairs(archive, rig.lips);
  for (auto& lids : rig.lids) pass_pairs(archive, lids);
  for (auto* lists : {&rig.lid_vertices, &rig.eye_skin}) {
    for (auto& list : *lists) archive.indices(list);
  }
  archive.indices(rig.lash_anchors);
  pass_rooms(archive, rig.rooms);
  archive.list(rig.reaches, [&](auto& reach) {
    archive.whole(reach.fap);
    archive.number(reach.low);
    archive.number(reach.high);
  });
  for (auto& usual : rig.usual) archive.number(usual);
  for (auto& arch : rig.teeth) pass_teeth(archive, arch);
  for (auto& follow : rig.lid_follow) archive.number(follow);
  archive.shares(rig.neck_weights);
  archive.runs(outside.outside);
  archive.runs(outside.rolls);
}

}  // namespace animeme::viewer::detail
