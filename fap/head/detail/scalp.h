// Hair that grows on the skull: a cap whose edge is the hair line, and locks that lie on it.
#pragma once

#include <functional>
#include <vector>

#include "fap/head/detail/shape.h"

namespace animeme::head::detail {

/// Directions from the middle of the skull: theta is the angle from the crown, phi 0 runs to the
/// front, pi/2 to the person's left.
class Scalp {
 public:
  /// The crown leans back by `tilt`, rad.
  Scalp(const Shape& shape, double tilt);

  Vec3d direction(double theta, double phi) const;
  /// The skin in a direction, and `height` above it.
  Vec3d place(double theta, double phi, double height) const;
  /// Where, coming from the crown, the skin gets below a height that depends on the place.
  double edge(double phi, const std::function<double(Vec3d)>& height) const;

 private:
  const Shape& shape_;
  Vec3d crown_, front_;
};

/// Thickness of a cap at theta, phi; `inside` is 0 at the edge, 1 at the crown.
using Thickness = std::function<double(double inside, double phi)>;

/// Adds a closed shell from the crown to the edges, with colours in strands; edges[i] is that of
/// column i, evenly around.
void add_cap(const Scalp& scalp, const std::vector<double>& edges, const Thickness& thickness,
             Vec3 colour, Mesh& mesh);

/// 0..1, scattered over i, the same on each call.
double scattered(int i);

/// A lock: a line of places, the directions away from the head, and its half width.
struct Lock {
  std::vector<Vec3d> places;
  std::vector<Vec3d> outwards;
  double width = 0.8;
  double flatness = 0.55;  ///< thickness against width
  float tint = 1;          ///< of its colour
};

/// Adds a lock, pointed at its end, with colours and the shade on its lower side.
void add_lock(const Lock& lock, Vec3 colour, Mesh& mesh);

}  // namespace animeme::head::detail
