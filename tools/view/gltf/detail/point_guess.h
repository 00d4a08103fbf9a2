// Feature points of a head that has shapes, from what the shapes move. All are estimates.
//
// - 3.1, 3.2: what a blink moves down most, the middle of the upper lid's rim.
// - 3.3, 3.4: nearest to where that comes down, among what the blink leaves: the lower lid's.
//   Without one, the middles of eyeballs tell how far apart the eyes are, and there are no lids.
// - 3.5, 3.6: the foremost vertex of an eyeball.
// - 2.2, 2.3: near the midline, where what stays and what goes down with the jaw are closest.
// - 9.3, 9.15: the foremost above the mouth; where the profile bends inwards most sharply, above
//   0.4 of the height from the lip to there.
// - 8.1, 8.2: on the midline 0.40 of MNS above 2.2, 0.46 below 2.3.
// - 2.10, 2.1: the foremost of the chin; where below it the skin has turned to below.
// - 8.3, 8.4: the ends of the slit between what goes down with the jaw and what stays.
// - 2.4, 2.5: in that slit, 5 % of the distance of the eyes further in.
// - 2.6 to 2.9: as 2.2 and 2.3, half way from there to the midline.
// - 4.1 to 4.6: the ends of the brows' meshes and their highest vertices. Without such meshes, of
//   what the inner brow's shape moves up nearly most the innermost, what the outer brow's shape
//   moves up most, and the middle of both.
// - 5.1, 5.2: what puffed cheeks move most to the side.
//
// A shape stands for "the jaw" and so on if it has the largest value of its FAP; visemes do if no
// shape of ARKit is there.
#pragma once

#include <optional>
#include <vector>

#include "fap/head/own_head.h"
#include "tools/view/gltf/detail/face_shapes.h"

namespace animeme::gltf {

/// Signed directions of the axes of the file that are left, up and forward on the face: rows of a
/// rotation by right angles. Left and right are told by shapes of one side, else by `eyes`
/// (centres, left and right). Nothing if neither is there, or nothing opens the mouth.
std::optional<std::array<head::Vec3, 3>> axes_of(
    const FaceShapes& face, const std::array<std::optional<head::Vec3>, 2>& eyes);

/// Those that can be told, in the order of their ids. The face looks along +Z, +Y is up.
std::vector<head::PiecePoint> guess_points(const FaceShapes& face);

}  // namespace animeme::gltf
