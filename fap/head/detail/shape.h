// The form of a face before it is a mesh: a distance field and the curves of lids and lips on it.
#pragma once

#include "fap/head/detail/distance.h"
#include "fap/head/model.h"

namespace animeme::head::detail {

/// Middle of the left nostril.
Vec3d nostril(const HeadParameters& parameters);

/// Everything about the left half (x >= 0); the right half is its mirror image.
struct Shape {
  explicit Shape(const HeadParameters& parameters);

  HeadParameters p;
  Form skin;       ///< face and neck, without lips, ears and hair
  Vec3d eye;       ///< centre of the left eye
  double lid = 0;  ///< radius of the outer side of the lids
  Vec3d jaw_axis;
  Vec3d neck_pivot;
  Vec3d ear;            ///< where the left ear grows: on the skin
  double ear_lean = 0;  ///< how much the side of the head goes outwards, by its height

  double inner_corner() const { return eye.x - p.eye_width / 2; }
  double outer_corner() const { return eye.x + p.eye_width / 2; }
  /// Height where the nose ends and the upper lip begins.
  double nose_base() const { return -p.nose_length - 0.97 * p.nose_size; }

  /// Rims of the lids and the crease above, as heights over x.
  double upper_lid(double x) const;
  double lower_lid(double x) const;
  double crease(double x) const;

  /// Heights over x >= 0: contact line and outer contours of the lips; they go on beyond the
  /// corner, where the three come together.
  double lip_line(double x) const;
  double upper_lip(double x) const;
  double lower_lip(double x) const;
  /// How thick a lip is at x: 1 in the middle, 0 at the corner.
  double lip_body(double x) const;

  /// Middle line of the left brow: t = 0 at the nose, 1 outside.
  Vec3d brow(double t) const;

  /// The surface as seen from the front at (x, y).
  Vec3d front(double x, double y) const;
};

}  // namespace animeme::head::detail
