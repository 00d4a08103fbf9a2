// FAPs of a recording as numbers that are not rounded yet. Internal.
#pragma once

#include <array>
#include <vector>

#include "fap/detail/landmark_face.h"

namespace animeme::fap::internal {

/// What a FAP does to which point of the track.
struct PointFap {
  int fap;
  std::size_t point;
  std::size_t axis;
  double sign;
};

/// A frame with values that may lie between the units.
struct ValueFrame {
  std::int64_t number = 0;
  Mask mask;
  std::array<double, kFapCount + 1> value{};
};

/// Errors: invalid_argument, see landmarks_to_fap().
Result<void> check_landmarks(const LandmarkTrack& track, const LandmarkOptions& options);

/// Averages of each FAP over the frames that have it, weighted by a bell of `width` seconds.
std::vector<ValueFrame> smoothed(const std::vector<ValueFrame>& frames, const Rate& rate,
                                 double width);

}  // namespace animeme::fap::internal
