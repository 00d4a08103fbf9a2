// Where the eyes of a recording look. Internal.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fap/detail/landmark_face.h"

namespace animeme::fap::internal {

using EyeAngles = EyeTurn;
/// Left and right.
using Eyes = std::array<std::optional<EyeAngles>, 2>;

class Gaze {
 public:
  /// All are borrowed.
  Gaze(const LandmarkTrack& track, const TrackedFace& face, const NeutralFace& neutral, double es);

  /// `head` is its turn against the camera, `still` the points with the head taken off.
  Eyes eyes(std::size_t frame, const Rotation& head, const std::vector<Point>& still) const;

 private:
  std::optional<EyeAngles> by_pupil(const Point& at, const Point& rest) const;

  const LandmarkTrack& track_;
  const NeutralFace& neutral_;
  double radius_;
  std::array<int, 2> pupils_;
};

}  // namespace animeme::fap::internal
