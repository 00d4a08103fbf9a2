// The profile of a face.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tools/view/gltf/detail/face_shapes.h"

namespace animeme::gltf {

/// Vertices of the skin near the middle of the face, from the eyes down, that can be seen from the
/// front or from before and below: neither the inside of the mouth nor that of the nose.
class Midline {
 public:
  /// `middle`: x of the plane; `between`: distance of the eyes, which all widths are shares of;
  /// `top`: where it begins.
  Midline(const SkinShapes& face, float middle, float between, float top);

  /// From above.
  const std::vector<Spot>& spots() const { return spots_; }
  /// The largest by a measure of the place, of what lies between two heights.
  Spot best(float top, float bottom, const std::function<float(head::Vec3)>& measure) const;
  Spot at_height(float y) const;
  /// Between two heights, where the profile bends inwards most sharply, as below the nose.
  Spot corner(float top, float bottom) const;
  /// Of what is as high, the nearest to the middle.
  Spot nearest_middle(Spot spot, const std::function<bool(Spot)>& allowed) const;

 private:
  using Corners = std::array<head::Vec3, 3>;
  std::vector<Corners> triangles_near() const;
  Spot corner_within(float reach, float top, float bottom) const;
  bool is_seen(head::Vec3 p, const std::vector<Corners>& triangles) const;

  const SkinShapes& face_;
  float middle_;
  float between_;
  std::vector<Spot> spots_;
};

}  // namespace animeme::gltf
